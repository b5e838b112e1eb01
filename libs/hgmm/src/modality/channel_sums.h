#pragma once
#include <Eigen/Core>
#include <array>

#include "modality/channel_mixture.h"

namespace hgmm {

/// Sums of points (x, lambda_1..lambda_J), from which moments of any union of sets follow
/// by addition: n, x (3), x x^T (upper triangle, 6); then for each channel lambda,
/// lambda^2, x lambda (3).
class ChannelSums {
 public:
    static constexpr int kPlace = 10, kChannel = 5;
    static constexpr int kMax = kPlace + kChannel * kMaxModalities;

    static int sizeFor(int channels) { return kPlace + kChannel * channels; }

    explicit ChannelSums(int channels) : channels_(channels), size_(sizeFor(channels)) {}

    double count() const { return v_[0]; }
    Eigen::Vector3d mean() const { return Eigen::Vector3d(v_[1], v_[2], v_[3]) / v_[0]; }
    Eigen::Matrix3d covariance() const;

    void add(const double* sums) {
        for (int k = 0; k < size_; ++k) v_[k] += sums[k];
    }
    void add(const ChannelSums& o) { add(o.v_.data()); }
    void add(const ChannelGaussian& component);

    /// Sum of squares of each channel about its mean.
    void spread(std::array<double, kMaxModalities>& out) const;
    /// Sum of squares that a linear function of x leaves of each channel.
    void unexplained(std::array<double, kMaxModalities>& out) const;
    /// The Gaussian of these moments. @param leastResidual [unit squared]
    ChannelGaussian gaussian(double leastResidual) const;

 private:
    int channels_, size_;
    std::array<double, kMax> v_{};
};

}  // namespace hgmm
