#include "fusion/update.h"

#include <algorithm>
#include <cmath>

#include "base/hash_table.h"
#include "base/portable_math.h"
#include "fusion/responsibilities.h"
#include "mixture/regularized.h"

namespace hgmm {

namespace {

struct RowKeys {
    static std::uint32_t unused() { return 0xFFFFFFFFU; }
    static std::uint32_t hash(std::uint32_t row) { return row * 0x9E3779B1U; }
};
using RowTable = HashTable<std::uint32_t, std::uint32_t, RowKeys>;

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
        additions.push_back(
            {j, portable::log(double(mixture.support[j])), mixture[j].mean});
    return additions;
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
    return regularized(g);
}

Gaussian<3> shareOf(const Gaussian<3>& old, const Addition& a) {
    Gaussian<3> g;
    g.support = a.support;
    const Eigen::Vector3d shift = a.sum / a.support;
    g.mean = old.mean + shift;
    g.covariance = a.sumOuter / a.support - shift * shift.transpose();
    return g;
}

}  // namespace

KnownUpdate updateKnown(const Mixture<3>& mixture, const ComponentIndex& index,
                        const Mixture<3>& samples, const NoveltySplit& split) {
    std::vector<Addition> additions = emptyAdditions(mixture, split);
    RowTable places;
    places.reserve(additions.size());
    for (std::uint32_t k = 0; k < additions.size(); ++k)
        places.tryEmplace(additions[k].component, k);
    std::vector<Addition*> neighbours;
    std::vector<double> p;
    for (std::size_t k = 0; k < split.known.size(); ++k) {
        const Gaussian<3> sample = samples[split.known[k]];
        const float point[3] = {float(sample.mean[0]), float(sample.mean[1]),
                                float(sample.mean[2])};
        neighbours.clear();
        for (std::uint32_t e = split.neighbourhoods.begin[k];
             e < split.neighbourhoods.begin[k + 1]; ++e)
            neighbours.push_back(
                &additions[*places.find(split.neighbourhoods.component[e])]);
        responsibilities(neighbours, index, point, p);
        for (std::size_t n = 0; n < neighbours.size(); ++n)
            neighbours[n]->add(p[n] * sample.support, sample);
    }
    KnownUpdate result;
    for (const Addition& addition : additions) {
        // A component far less likely than its neighbours may be given next to nothing.
        if (!(addition.support > 1e-6)) continue;
        const Gaussian<3> old = mixture[addition.component];
        result.changed.push_back(addition.component);
        result.components.push_back(updated(old, addition));
        result.shares.push_back(shareOf(old, addition));
    }
    return result;
}

}  // namespace hgmm
