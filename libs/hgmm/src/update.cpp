#include "hgmm/update.h"

#include <algorithm>
#include <cmath>

#include "storable.h"

namespace hgmm {

namespace {

/// What one scan adds to a component: responsibility-weighted sums about its old mean.
struct Addition {
    std::uint32_t component;
    double logSupport;  ///< before the scan
    Eigen::Vector3d oldMean;
    double support = 0;
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    Eigen::Matrix3d sumOuter = Eigen::Matrix3d::Zero();

    void add(double share, const Gaussian<3>& sample) {
        const Eigen::Vector3d d = sample.mean - oldMean;
        support += share;
        sum += share * d;
        sumOuter += share * (sample.covariance + d * d.transpose());
    }
};

/// One for each component that is some sample's neighbour, rising.
std::vector<Addition> emptyAdditions(const Mixture<3>& mixture, const NoveltySplit& split) {
    std::vector<std::uint32_t> components = split.neighbourhoods.component;
    std::sort(components.begin(), components.end());
    components.erase(std::unique(components.begin(), components.end()), components.end());
    std::vector<Addition> additions;
    additions.reserve(components.size());
    for (const std::uint32_t j : components)
        additions.push_back({j, std::log(double(mixture.support[j])), mixture[j].mean});
    return additions;
}

/// Weights that sum to 1 from their logarithms.
void normalise(std::vector<double>& p) {
    const double largest = *std::max_element(p.begin(), p.end());
    double sum = 0;
    for (double& v : p) sum += v = std::exp(v - largest);
    for (double& v : p) v /= sum;
}

/// p_ij of eq. (3.19) over a sample's neighbourhood: eq. (3.8) in log space. Supports stand
/// for the weights pi_j = S_j / N, whose common N cancels.
void responsibilities(const std::vector<Addition*>& neighbours, const ComponentIndex& index,
                      const float* point, std::vector<double>& p) {
    p.clear();
    for (const Addition* neighbour : neighbours)
        p.push_back(neighbour->logSupport +
                    index.factor(neighbour->component).logPdf(point));
    normalise(p);
}

Gaussian<3> updated(const Gaussian<3>& old, const Addition& a) {
    Gaussian<3> g;
    g.support = old.support + a.support;  // thesis eq. (3.19)
    const Eigen::Vector3d shift = a.sum / g.support;
    g.mean = old.mean + shift;  // thesis eq. (3.21)
    g.covariance = (old.support * old.covariance + a.sumOuter) / g.support -
                   shift * shift.transpose();  // thesis eq. (3.22)
    return storable(g);
}

Gaussian<3> shareOf(const Gaussian<3>& old, const Addition& a) {
    Gaussian<3> g;
    g.support = a.support;
    const Eigen::Vector3d shift = a.sum / a.support;
    g.mean = old.mean + shift;
    g.covariance = a.sumOuter / a.support - shift * shift.transpose();
    return g;
}

/// Support of a sample that falls to a component.
struct Share {
    std::uint32_t component;
    double support;
};

/// What outgrown components would be given of the samples, components rising.
std::vector<Share> outgrownShares(const Mixture<3>& mixture, const ComponentIndex& index,
                                  const Mixture<3>& samples, const NoveltySplit& split) {
    std::vector<Share> shares;
    std::vector<double> p;
    std::size_t k = 0;  // of the known samples, the next one
    for (std::size_t begin = 0, end; begin < split.outgrown.size(); begin = end) {
        const std::uint32_t i = split.outgrown[begin].sample;
        for (end = begin; end < split.outgrown.size() && split.outgrown[end].sample == i;)
            ++end;
        const float point[3] = {samples.mean[0][i], samples.mean[1][i], samples.mean[2][i]};
        const auto add = [&](std::uint32_t j) {
            p.push_back(std::log(double(mixture.support[j])) +
                        index.factor(j).logPdf(point));
        };
        p.clear();
        for (std::size_t o = begin; o < end; ++o) add(split.outgrown[o].component);
        while (k < split.known.size() && split.known[k] < i) ++k;
        if (k < split.known.size() && split.known[k] == i)
            for (std::uint32_t e = split.neighbourhoods.begin[k];
                 e < split.neighbourhoods.begin[k + 1]; ++e)
                add(split.neighbourhoods.component[e]);
        normalise(p);
        for (std::size_t o = begin; o < end; ++o)
            shares.push_back(
                {split.outgrown[o].component, p[o - begin] * samples.support[i]});
    }
    std::stable_sort(shares.begin(), shares.end(), [](const Share& a, const Share& b) {
        return a.component < b.component;
    });
    return shares;
}

}  // namespace

KnownUpdate updateKnown(Mixture<3>& mixture, const ComponentIndex& index,
                        const Mixture<3>& samples, const NoveltySplit& split) {
    std::vector<Addition> additions = emptyAdditions(mixture, split);
    std::vector<Addition*> neighbours;
    std::vector<double> p;
    for (std::size_t k = 0; k < split.known.size(); ++k) {
        const Gaussian<3> sample = samples[split.known[k]];
        const float point[3] = {float(sample.mean[0]), float(sample.mean[1]),
                                float(sample.mean[2])};
        neighbours.clear();
        for (std::uint32_t e = split.neighbourhoods.begin[k];
             e < split.neighbourhoods.begin[k + 1]; ++e)
            neighbours.push_back(&*std::lower_bound(
                additions.begin(), additions.end(), split.neighbourhoods.component[e],
                [](const Addition& a, std::uint32_t j) { return a.component < j; }));
        responsibilities(neighbours, index, point, p);
        for (std::size_t n = 0; n < neighbours.size(); ++n)
            neighbours[n]->add(p[n] * sample.support, sample);
    }
    KnownUpdate result;
    for (const Addition& addition : additions) {
        // A component far less likely than its neighbours may be given next to nothing.
        if (!(addition.support > 1e-6)) continue;
        const Gaussian<3> old = mixture[addition.component];
        mixture.set(addition.component, updated(old, addition));
        result.changed.push_back(addition.component);
        result.shares.push_back(shareOf(old, addition));
    }
    return result;
}

std::vector<Loss> giveWay(Mixture<3>& mixture, const ComponentIndex& index,
                          const Mixture<3>& samples, const NoveltySplit& split) {
    const std::vector<Share> shares = outgrownShares(mixture, index, samples, split);
    std::vector<Loss> losses;
    for (std::size_t s = 0; s < shares.size();) {
        const std::uint32_t j = shares[s].component;
        double lost = 0;
        for (; s < shares.size() && shares[s].component == j; ++s)
            lost += shares[s].support;
        const float before = mixture.support[j],
                    after = std::max(static_cast<float>(before - lost), kNoSupport);
        if (!(after < before)) continue;
        mixture.support[j] = after;
        losses.push_back({j, double(after) / double(before)});
    }
    return losses;
}

}  // namespace hgmm
