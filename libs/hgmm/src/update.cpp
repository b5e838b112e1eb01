#include "hgmm/update.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "storable.h"

namespace hgmm {

namespace {

/// What one scan adds to a component: responsibility-weighted sums about its old mean.
struct Addition {
    double support = 0;
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    Eigen::Matrix3d sumOuter = Eigen::Matrix3d::Zero();
};

/// p_ij of eq. (3.19) over a sample's neighbourhood: eq. (3.8) in log space. Supports stand
/// for the weights pi_j = S_j / N, whose common N cancels.
void responsibilities(const Mixture<3>& mixture, const ComponentIndex& index,
                      const std::uint32_t* first, const std::uint32_t* last,
                      const float* point, std::vector<double>& p) {
    p.clear();
    double largest = -std::numeric_limits<double>::infinity();
    for (const std::uint32_t* j = first; j != last; ++j) {
        p.push_back(std::log(double(mixture.support[*j])) + index.factor(*j).logPdf(point));
        largest = std::max(largest, p.back());
    }
    double sum = 0;
    for (double& v : p) sum += v = std::exp(v - largest);
    for (double& v : p) v /= sum;
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

}  // namespace

KnownUpdate updateKnown(Mixture<3>& mixture, const ComponentIndex& index,
                        const Mixture<3>& samples, const NoveltySplit& split) {
    std::vector<Addition> additions;
    std::vector<std::uint32_t> changed = split.neighbourhoods.component;
    std::sort(changed.begin(), changed.end());
    changed.erase(std::unique(changed.begin(), changed.end()), changed.end());
    additions.resize(changed.size());

    std::vector<double> p;
    for (std::size_t k = 0; k < split.known.size(); ++k) {
        const Gaussian<3> sample = samples[split.known[k]];
        const float point[3] = {float(sample.mean[0]), float(sample.mean[1]),
                                float(sample.mean[2])};
        const std::uint32_t* components = split.neighbourhoods.component.data();
        const std::uint32_t* first = components + split.neighbourhoods.begin[k];
        const std::uint32_t* last = components + split.neighbourhoods.begin[k + 1];
        responsibilities(mixture, index, first, last, point, p);
        for (const std::uint32_t* j = first; j != last; ++j) {
            const auto slot =
                std::lower_bound(changed.begin(), changed.end(), *j) - changed.begin();
            Addition& a = additions[static_cast<std::size_t>(slot)];
            const double support = p[static_cast<std::size_t>(j - first)] * sample.support;
            const Eigen::Vector3d d = sample.mean - mixture[*j].mean;
            a.support += support;
            a.sum += support * d;
            a.sumOuter += support * (sample.covariance + d * d.transpose());
        }
    }
    KnownUpdate result;
    for (std::size_t c = 0; c < changed.size(); ++c) {
        // A component far less likely than its neighbours may be given next to nothing.
        if (!(additions[c].support > 1e-6)) continue;
        const Gaussian<3> old = mixture[changed[c]];
        mixture.set(changed[c], updated(old, additions[c]));
        result.changed.push_back(changed[c]);
        result.shares.push_back(shareOf(old, additions[c]));
    }
    return result;
}

}  // namespace hgmm
