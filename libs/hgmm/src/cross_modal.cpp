#include <algorithm>
#include <cmath>
#include <limits>

#include "hgmm/gaussian.h"
#include "hgmm/map.h"
#include "modality_inference.h"
#include "value_index.h"

namespace hgmm {

namespace {

/// Candidate places of one prior, by falling weight.
class CandidatePlaces {
 public:
    static constexpr std::size_t kMost = 6;

    void add(double logWeight, const Eigen::Vector3d& place) {
        if (size_ == kMost && !(logWeight > weights_[kMost - 1])) return;
        std::size_t at = size_ < kMost ? size_++ : kMost - 1;
        for (; at > 0 && weights_[at - 1] < logWeight; --at) {
            weights_[at] = weights_[at - 1];
            places_[at] = places_[at - 1];
        }
        weights_[at] = logWeight;
        places_[at] = place;
    }
    std::size_t size() const { return size_; }
    const Eigen::Vector3d& operator[](std::size_t i) const { return places_[i]; }

 private:
    std::size_t size_ = 0;
    std::array<double, kMost> weights_{};
    std::array<Eigen::Vector3d, kMost> places_;
};

/// A component seen from its value: thesis eq. (5.9) to (5.11).
struct GivenValue {
    double logWeight;                ///< of eq. (5.9), without the common denominator
    Eigen::Vector3d mean;            ///< eq. (5.10)
    Gaussian<3>::Matrix covariance;  ///< eq. (5.11)
};

GivenValue givenValue(const ChannelGaussian& g, int channel, double value) {
    const Gaussian<4> joint = g.joint(channel);
    const double variance = joint.covariance(3, 3), d = value - joint.mean[3];
    const Eigen::Vector3d cross = joint.covariance.topRightCorner<3, 1>();
    GivenValue out;
    out.logWeight = std::log(joint.support) - 0.5 * (std::log(variance) + d * d / variance);
    out.mean = joint.mean.head<3>() + cross * (d / variance);
    out.covariance =
        joint.covariance.topLeftCorner<3, 3>() - cross * cross.transpose() / variance;
    return out;
}

void candidatesNear(const ModalityMap& prior, double value, const Eigen::Vector3d& point,
                    CandidatePlaces& places) {
    const ModalityGroup& group = prior.group();
    const Eigen::Vector3f p = point.cast<float>();
    group.index().visitCandidates(p.x(), p.y(), p.z(), [&](std::uint32_t j) {
        constexpr float kSigmas = ComponentIndex::kSigmas;
        if (!(group.index().factor(j).squaredMahalanobis(p.data()) <= kSigmas * kSigmas))
            return;
        const GivenValue given = givenValue(group.mixture()[j], prior.channel(), value);
        Gaussian<3> place;
        place.mean = given.mean;
        place.covariance = given.covariance;
        // thesis eq. (5.8)
        places.add(given.logWeight + WhitenedGaussian<3>(place).logPdf(point.data()),
                   given.mean);
    });
}

void candidatesAnywhere(const ModalityMap& prior, double value, CandidatePlaces& places) {
    const ModalityGroup& group = prior.group();
    for (const std::uint32_t j : group.byValue(prior.channel()).at(value)) {
        const GivenValue given = givenValue(group.mixture()[j], prior.channel(), value);
        places.add(given.logWeight, given.mean);
    }
}

}  // namespace

CrossModalEstimate inferModality(const ModalityMap& target,
                                 const std::vector<Prior>& priors,
                                 const Eigen::Vector3d* point) {
    CrossModalEstimate best;
    const auto consider = [&](const Eigen::Vector3d& place) {
        double likelihood = 0;
        for (const Prior& prior : priors)
            likelihood += std::exp(prior.map->logLikelihood(prior.value, place));
        if (best.known && !(likelihood > best.likelihood)) return;
        const ModalityEstimate there = target.at(place);
        if (!there.known) return;
        best = {there.mean, there.variance, true, place, likelihood};
    };
    for (const Prior& prior : priors) {
        CandidatePlaces places;
        if (point != nullptr) candidatesNear(*prior.map, prior.value, *point, places);
        if (places.size() == 0) candidatesAnywhere(*prior.map, prior.value, places);
        for (std::size_t i = 0; i < places.size(); ++i) consider(places[i]);
    }
    return best;
}

}  // namespace hgmm
