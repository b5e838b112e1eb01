#pragma once
#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <vector>

#include "hgmm/mixture.h"
#include "hgmm/params.h"

namespace hgmm {

/// How a modality goes with place within one component: Lambda = mean + slope^T (x - mu_X),
/// give or take the residual (thesis eq. (5.4), (5.5)).
struct ChannelFit {
    double mean = 0.0;                                ///< mu_Lambda [unit of the channel]
    Eigen::Vector3d slope = Eigen::Vector3d::Zero();  ///< Sigma_XX^-1 Sigma_XLambda [1/m]
    double residual = 1.0;  ///< sigma^2 of eq. (5.5) [unit squared], > 0
};

/// A component of the mixtures over (X, Lambda_j), j < J, of modalities measured together:
/// they share the place, which is their common marginal over X.
struct ChannelGaussian {
    Gaussian<3> place;
    std::array<ChannelFit, kMaxModalities> fits;  ///< the first J count

    /// The component over (X, Lambda_channel), thesis eq. (5.1).
    Gaussian<4> joint(int channel) const;
};

/// J mixtures over (X, Lambda_j) (thesis eq. (5.1)) whose components share their places.
class ChannelMixture {
 public:
    /// @param channels J, in [1, kMaxModalities]
    explicit ChannelMixture(int channels = 1);

    int channels() const { return static_cast<int>(fits_.size()); }
    std::size_t size() const { return places_.size(); }
    bool empty() const { return places_.empty(); }
    const Mixture<3>& places() const { return places_; }

    /// The place is widened, and the residual raised, where they would not stay positive
    /// in floats.
    void pushBack(const ChannelGaussian& component);
    void set(std::size_t i, const ChannelGaussian& component);
    ChannelGaussian operator[](std::size_t i) const;

    float mean(int channel, std::size_t i) const { return fits_[channel].mean[i]; }
    float slope(int channel, int axis, std::size_t i) const {
        return fits_[channel].slope[axis][i];
    }
    float residual(int channel, std::size_t i) const { return fits_[channel].residual[i]; }

    /// The mixture over (X, Lambda_channel).
    Mixture<4> joint(int channel) const;
    /// The same components with these channels only, in this order.
    ChannelMixture withChannels(const std::vector<int>& channels) const;

    /// The components of these rows, bit for bit.
    ChannelMixture rows(const std::vector<std::size_t>& rows) const;

    /// Throws std::logic_error like Mixture::check.
    void check() const;
    /// Heap held [bytes].
    std::size_t liveBytes() const;
    bool operator==(const ChannelMixture& o) const {
        return places_ == o.places_ && fits_ == o.fits_;
    }

    /// Calls visit(array) for the arrays of one channel: for saving and loading.
    template <typename Visitor>
    void forEachArray(int channel, Visitor&& visit) {
        fits_.at(static_cast<std::size_t>(channel)).forEachArray(visit);
    }
    template <typename Visitor>
    void forEachArray(int channel, Visitor&& visit) const {
        fits_.at(static_cast<std::size_t>(channel)).forEachArray(visit);
    }
    /// Replaces the places; arrays of channels take their size. For loading.
    void assignPlaces(Mixture<3> places);

 private:
    struct Fits {
        std::vector<float> mean, residual;
        std::array<std::vector<float>, 3> slope;

        template <typename Visitor>
        void forEachArray(Visitor&& visit) {
            visit(mean);
            visit(residual);
            for (auto& axis : slope) visit(axis);
        }
        template <typename Visitor>
        void forEachArray(Visitor&& visit) const {
            visit(mean);
            visit(residual);
            for (const auto& axis : slope) visit(axis);
        }
        bool operator==(const Fits& o) const {
            return mean == o.mean && residual == o.residual && slope == o.slope;
        }
    };

    Mixture<3> places_;
    std::vector<Fits> fits_;
};

}  // namespace hgmm
