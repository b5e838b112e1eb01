#include "hgmm/thickness.h"

#include <Eigen/Eigenvalues>

namespace hgmm {

Eigen::Vector3d normalOfRays(const Mixture<3>& samples_sensor) {
    constexpr double kMaxSlope = 0.01, kLeastSpread = 10 * kMaxSlope;
    Eigen::Matrix3d scatter = Eigen::Matrix3d::Zero();
    double rays = 0;
    const auto& mean = samples_sensor.mean;
    for (std::size_t i = 0; i < samples_sensor.size(); ++i) {
        const Eigen::Vector3d ray(mean[0][i], mean[1][i], mean[2][i]);
        const double squared = ray.squaredNorm();
        if (!(squared > 0)) continue;
        scatter += ray * ray.transpose() / squared;
        rays += 1;
    }
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> eigen(scatter);
    const Eigen::Vector3d& spread = eigen.eigenvalues();
    if (spread[0] > kMaxSlope * kMaxSlope * rays ||
        !(spread[1] > kLeastSpread * kLeastSpread * rays))
        return Eigen::Vector3d::Zero();
    return eigen.eigenvectors().col(0);
}

double ThicknessLimit::maxVarianceAt(double range_m) const {
    const double thickness = maxThickness * cells.edgeAt(range_m),
                 noise = filter.noiseAt(range_m);
    return thickness * thickness + noise * noise;
}

}  // namespace hgmm
