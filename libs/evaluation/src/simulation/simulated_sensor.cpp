#include "hgmm/evaluation/simulated_sensor.h"

#include <Eigen/Geometry>
#include <cmath>

#include "hgmm/evaluation/split.h"

namespace hgmm::evaluation {
namespace {

constexpr double kRadiansPerDegree = 0.017453292519943295;  ///< [rad]

Eigen::Vector3d directionAt(double azimuth_rad, double elevation_rad) {
    return {std::cos(elevation_rad) * std::cos(azimuth_rad),
            std::cos(elevation_rad) * std::sin(azimuth_rad), std::sin(elevation_rad)};
}

}  // namespace

SimulatedSensor ringLidar(int rings, double lowest_deg, double highest_deg, int raysPerRing,
                          double maxRange_m) {
    SimulatedSensor sensor{
        std::to_string(rings) + " rings", SensorKind::lidar, {}, maxRange_m};
    for (int ring = 0; ring < rings; ++ring) {
        const double elevation_deg =
            lowest_deg + (highest_deg - lowest_deg) * ring / (rings - 1);
        for (int i = 0; i < raysPerRing; ++i)
            sensor.directions_sensor.push_back(
                directionAt(360.0 * kRadiansPerDegree * i / raysPerRing,
                            elevation_deg * kRadiansPerDegree));
    }
    return sensor;
}

SimulatedSensor depthCamera(int width, int height, double openingAngle_deg,
                            double maxRange_m) {
    SimulatedSensor sensor{"camera", SensorKind::depthCamera, {}, maxRange_m};
    const double focal_px =
        0.5 * width / std::tan(0.5 * openingAngle_deg * kRadiansPerDegree);
    for (int row = 0; row < height; ++row)
        for (int column = 0; column < width; ++column) {
            const double left = 0.5 * (width - 1) - column, up = 0.5 * (height - 1) - row;
            sensor.directions_sensor.push_back(
                Eigen::Vector3d(focal_px, left, up).normalized());
        }
    return sensor;
}

SimulatedSensor planarLaser(int rays, double openingAngle_deg, double maxRange_m) {
    SimulatedSensor sensor{"2D", SensorKind::lidar, {}, maxRange_m};
    for (int i = 0; i < rays; ++i) {
        const double azimuth_deg = openingAngle_deg * (i / (rays - 1.0) - 0.5);
        sensor.directions_sensor.push_back(
            directionAt(azimuth_deg * kRadiansPerDegree, 0.0));
    }
    return sensor;
}

std::vector<SimulatedReturn> simulateReturns(const Scene& scene,
                                             const SimulatedSensor& sensor,
                                             const Pose& T_map_sensor,
                                             const RangeErrors& errors, std::uint64_t seed,
                                             std::size_t scanIndex) {
    const std::size_t n = sensor.directions_sensor.size();
    std::vector<SimulatedReturn> returns(n);
#pragma omp parallel for schedule(static)
    for (std::size_t i = 0; i < n; ++i) {
        const auto hit =
            scene.cast(T_map_sensor.t, T_map_sensor.R * sensor.directions_sensor[i]);
        if (hit && hit->range_m <= sensor.maxRange_m)
            returns[i] = {true, hit->range_m, *hit};
        else
            returns[i].range_m = sensor.maxRange_m;
    }
    std::mt19937_64 noise = randomStream(seed, scanIndex, Draw::rangeNoise);
    std::mt19937_64 dust = randomStream(seed, scanIndex, Draw::dust);
    for (SimulatedReturn& r : returns) {
        // Drawn for rays without return as well, so that one ray never shifts others.
        const double noise_m =
            errors.noise_m > 0.0 ? errors.noise_m * nextNormal(noise) : 0.0;
        const bool inDust = errors.dustShare > 0.0 && nextUniform(dust) < errors.dustShare;
        const double share = errors.dustShare > 0.0 ? nextUniform(dust) : 0.0;
        if (!r.hit) continue;
        r.range_m = std::max(r.truth.range_m + noise_m, 1e-3);
        if (inDust && r.truth.range_m > errors.dustFrom_m)
            r.range_m = errors.dustFrom_m + share * (r.truth.range_m - errors.dustFrom_m);
    }
    return returns;
}

Scan scanOf(const std::vector<SimulatedReturn>& returns, const SimulatedSensor& sensor,
            const Pose& T_map_sensor, WithoutReturn withoutReturn) {
    Scan scan;
    scan.T_map_sensor = T_map_sensor;
    scan.reserve(returns.size());
    for (std::size_t i = 0; i < returns.size(); ++i) {
        const Eigen::Vector3d& direction = sensor.directions_sensor[i];
        if (returns[i].hit) {
            const Eigen::Vector3f p_sensor = (returns[i].range_m * direction).cast<float>();
            scan.pushBack(p_sensor.x(), p_sensor.y(), p_sensor.z());
        } else if (withoutReturn == WithoutReturn::clears) {
            scan.clearedRays.push_back(
                {direction.cast<float>(), static_cast<float>(sensor.maxRange_m)});
        }
    }
    return scan;
}

std::vector<SurfacePoint> idealView(const Scene& scene, const SimulatedSensor& sensor,
                                    const Pose& T_map_sensor) {
    const std::vector<SimulatedReturn> returns =
        simulateReturns(scene, sensor, T_map_sensor, {}, 0, 0);
    std::vector<SurfacePoint> view;
    for (std::size_t i = 0; i < returns.size(); ++i) {
        if (!returns[i].hit) continue;
        const Eigen::Vector3d direction = T_map_sensor.R * sensor.directions_sensor[i];
        const SceneHit& truth = returns[i].truth;
        view.push_back({T_map_sensor.t + truth.range_m * direction, truth.part,
                        -direction.dot(truth.normal)});
    }
    return view;
}

}  // namespace hgmm::evaluation
