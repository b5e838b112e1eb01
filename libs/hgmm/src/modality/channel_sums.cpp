#include "modality/channel_sums.h"

#include <Eigen/Cholesky>
#include <algorithm>

namespace hgmm {

namespace {

/// A covariance that can be factored: sums carry the sensor's noise, so that only rounding
/// makes this widen it.
Eigen::LLT<Eigen::Matrix3d> factored(Eigen::Matrix3d covariance) {
    const double floor = 1e-9 * covariance.trace() + 1e-12;
    covariance.diagonal().array() += floor;
    Eigen::LLT<Eigen::Matrix3d> factor(covariance);
    for (double more = floor; factor.info() != Eigen::Success; more *= 10) {
        covariance.diagonal().array() += more;
        factor.compute(covariance);
    }
    return factor;
}

}  // namespace

Eigen::Matrix3d ChannelSums::covariance() const {
    const Eigen::Vector3d m = mean();
    Eigen::Matrix3d C;
    for (int row = 0, k = 4; row < 3; ++row)
        for (int col = row; col < 3; ++col, ++k)
            C(row, col) = C(col, row) = v_[k] / v_[0] - m[row] * m[col];
    return C;
}

void ChannelSums::add(const ChannelGaussian& component) {
    const double n = component.place.support;
    const Eigen::Vector3d x = component.place.mean;
    const Eigen::Matrix3d C = component.place.covariance;
    v_[0] += n;
    for (int d = 0; d < 3; ++d) v_[1 + d] += n * x[d];
    for (int row = 0, k = 4; row < 3; ++row)
        for (int col = row; col < 3; ++col, ++k)
            v_[k] += n * (C(row, col) + x[row] * x[col]);
    double* v = v_.data() + kPlace;
    for (int c = 0; c < channels_; ++c, v += kChannel) {
        const ChannelFit& fit = component.fits[c];
        const Eigen::Vector3d cross = C * fit.slope;
        v[0] += n * fit.mean;
        v[1] += n * (fit.residual + fit.slope.dot(cross) + fit.mean * fit.mean);
        for (int d = 0; d < 3; ++d) v[2 + d] += n * (cross[d] + x[d] * fit.mean);
    }
}

void ChannelSums::spread(std::array<double, kMaxModalities>& out) const {
    const double* v = v_.data() + kPlace;
    for (int c = 0; c < channels_; ++c, v += kChannel)
        out[c] = std::max(0.0, v[1] - v[0] * v[0] / v_[0]);
}

void ChannelSums::unexplained(std::array<double, kMaxModalities>& out) const {
    spread(out);
    const auto factor = factored(covariance());
    const Eigen::Vector3d m = mean();
    const double* v = v_.data() + kPlace;
    for (int c = 0; c < channels_; ++c, v += kChannel) {
        const Eigen::Vector3d cross =
            Eigen::Vector3d(v[2], v[3], v[4]) / v_[0] - m * v[0] / v_[0];
        out[c] =
            std::max(0.0, out[c] - v_[0] * factor.matrixL().solve(cross).squaredNorm());
    }
}

ChannelGaussian ChannelSums::gaussian(double leastResidual) const {
    ChannelGaussian g;
    const Eigen::Matrix3d C = covariance();
    const auto factor = factored(C);
    const Eigen::Vector3d m = mean();
    g.place.support = v_[0];
    g.place.mean = m;
    g.place.covariance = C;
    std::array<double, kMaxModalities> rest{};
    unexplained(rest);
    const double* v = v_.data() + kPlace;
    for (int c = 0; c < channels_; ++c, v += kChannel) {
        ChannelFit& fit = g.fits[c];
        const Eigen::Vector3d cross =
            Eigen::Vector3d(v[2], v[3], v[4]) / v_[0] - m * v[0] / v_[0];
        fit.mean = v[0] / v_[0];
        fit.slope = factor.solve(cross);
        fit.residual = std::max(rest[c] / v_[0], leastResidual);
    }
    return g;
}

}  // namespace hgmm
