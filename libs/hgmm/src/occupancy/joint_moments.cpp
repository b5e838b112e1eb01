#include "hgmm/joint_moments.h"

namespace hgmm {

namespace {

/// Thickness of free components along W [m]: keeps them positive definite.
constexpr double kDistanceStd_m = 0.01;

}  // namespace

Gaussian<4> augmented(const Gaussian<3>& surface, const ViewDirection& view, double width_m,
                      double freeShare) {
    const Eigen::Vector3d& u = view.direction;
    const double meanW = freeShare * width_m / 2;
    const double varW = freeShare * width_m * width_m / 3 - meanW * meanW;
    Gaussian<4> g;
    g.support = surface.support / (1 - freeShare);
    g.mean.head<3>() = surface.mean + meanW * u;
    g.mean[3] = meanW;
    g.covariance.topLeftCorner<3, 3>() = surface.covariance + varW * u * u.transpose();
    g.covariance.topRightCorner<3, 1>() = varW * u;
    g.covariance.bottomLeftCorner<1, 3>() = varW * u.transpose();
    g.covariance(3, 3) = varW;
    return g;
}

Gaussian<4> raySegmentMoments(const Gaussian<3>& hits, const Eigen::Vector3d& sensorOrigin,
                              double from_m, double to_m) {
    const Eigen::Vector3d ray = sensorOrigin - hits.mean;
    const double range = ray.norm();
    const double meanW = (from_m + to_m) / 2;
    const double varW = (to_m - from_m) * (to_m - from_m) / 12;
    // x = s (1 - w / R) + o w / R for s in the hits: E[(1 - w / R)^2] scales their scatter.
    const double narrowing = 1 - meanW / range;
    const double scatter = narrowing * narrowing + varW / (range * range);
    const Eigen::Vector3d u = ray / range;
    Gaussian<4> g;
    g.support = hits.support;
    g.mean.head<3>() = hits.mean + meanW * u;
    g.mean[3] = meanW;
    g.covariance.topLeftCorner<3, 3>() =
        scatter * hits.covariance + varW * u * u.transpose() +
        kDistanceStd_m * kDistanceStd_m * Eigen::Matrix3d::Identity();
    g.covariance.topRightCorner<3, 1>() = varW * u;
    g.covariance.bottomLeftCorner<1, 3>() = varW * u.transpose();
    g.covariance(3, 3) = varW + kDistanceStd_m * kDistanceStd_m;
    return g;
}

}  // namespace hgmm
