#include "scan/scan_samples.h"

#include <Eigen/Eigenvalues>

#include "scan/cleared_rays.h"
#include "scan/ray_spacing.h"
#include "scan/ring_interpolation.h"

namespace hgmm {

Eigen::Vector3d normalOfRays(const Mixture<3>& samples_sensor,
                             const std::vector<ClearedRay>& clearedRays_sensor) {
    constexpr double kMaxSlope = 0.01, kLeastRaySpread = 10 * kMaxSlope;
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
    for (const ClearedRay& ray : clearedRays_sensor) {
        const Eigen::Vector3d direction = ray.direction.cast<double>();
        scatter += direction * direction.transpose();
        rays += 1;
    }
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> eigen(scatter);
    const Eigen::Vector3d& spread = eigen.eigenvalues();
    if (spread[0] > kMaxSlope * kMaxSlope * rays ||
        !(spread[1] > kLeastRaySpread * kLeastRaySpread * rays))
        return Eigen::Vector3d::Zero();
    return eigen.eigenvectors().col(0);
}

ScanSamples samplesOf(const Scan& scan, const MapParams& params) {
    scan.validate();
    params.filter.validate();
    params.cells.validate();
    ScanSamples result;
    result.samples_sensor = filterScan(scan, params.filter, &result.points);
    if (result.points.cut > 0 || !scan.clearedRays.empty())
        result.clearedRays_sensor = clearedRaysOf(scan, params.filter);
    interpolateRings(result.samples_sensor, params.cells);
    result.normalOfRays_sensor =
        normalOfRays(result.samples_sensor, result.clearedRays_sensor);
    result.raySpacing_rad = raySpacing(result.samples_sensor, result.normalOfRays_sensor);
    return result;
}

}  // namespace hgmm
