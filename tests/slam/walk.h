#pragma once
#include <hgmm/evaluation/scene.h>
#include <hgmm/evaluation/simulated_sensor.h>

#include <cmath>
#include <random>
#include <utility>
#include <vector>

#include "hgmm/slam/submap_slam.h"

namespace hgmm::slam::testing {

using evaluation::Part;
using evaluation::Scene;
using evaluation::SimulatedSensor;

/// A corridor about a block, with pillars at (x, y).
inline Scene ringCorridorWith(const std::vector<std::pair<double, double>>& pillars) {
    const auto box = [](double x0, double y0, double x1, double y1) {
        return evaluation::Box{{x0, y0, -1.0}, {x1, y1, 2.0}};
    };
    Scene scene;
    for (const auto& wall : {box(-8, -8, 8, -7.8), box(-8, 7.8, 8, 8), box(-8, -8, -7.8, 8),
                             box(7.8, -8, 8, 8), box(-4, -4, 4, 4)})
        scene.add(wall, Part::wall);
    for (const auto& [x, y] : pillars)
        scene.add(evaluation::Pillar{{x, y}, 0.2, -1.0, 2.0}, Part::pole);
    return scene;
}

/// The same with pillars that are nowhere twice as far apart.
inline Scene ringCorridor() {
    return ringCorridorWith({{-6.0, -7.4},
                             {1.5, -7.5},
                             {5.2, -4.6},
                             {7.3, -1.0},
                             {7.2, 5.0},
                             {4.5, 6.9},
                             {-0.5, 7.5},
                             {-3.1, 4.6},
                             {-7.3, 3.5},
                             {-4.5, -0.7},
                             {-7.4, -3.0}});
}

/// Poses once about the block, and a little farther, at steps of `step_m`.
inline std::vector<Pose> walkAround(double step_m, double laps) {
    constexpr double kHalf = 6.0, kSide = 2 * kHalf;
    std::vector<Pose> poses;
    for (double s = 0; s < laps * 4 * kSide; s += step_m) {
        const int side = static_cast<int>(s / kSide) % 4;
        const double along = std::fmod(s, kSide) - kHalf;
        const Eigen::Matrix3d turn = rotationOf({0, 0, side * M_PI_2});
        poses.push_back({turn, turn * Eigen::Vector3d(along, -kHalf, 0)});
    }
    return poses;
}

inline SimulatedSensor laser() {
    return evaluation::planarLaser(240, 270.0, 12.0);
}

/// What the laser sees from a pose, as samples.
inline ScanSamples samplesAt(const Scene& scene, const Pose& T_world_sensor,
                             std::size_t index, const MapParams& params = {}) {
    const SimulatedSensor sensor = laser();
    const Pose T;
    return samplesOf(
        evaluation::scanOf(evaluation::simulateReturns(scene, sensor, T_world_sensor,
                                                       {0.01, 0.0, 0.3}, 3, index),
                           sensor, T, evaluation::WithoutReturn::leftOut),
        params);
}

/// A true motion with noise, and a bias of the heading.
inline UncertainPose drifting(const Pose& motion, double bias_rad,
                              std::mt19937_64& random) {
    std::normal_distribution<double> normal;
    Vector6d error = Vector6d::Zero();
    error[2] = bias_rad + 0.002 * normal(random);
    error[3] = 0.005 * normal(random);
    error[4] = 0.005 * normal(random);
    UncertainPose odometry{displacedBy(motion, error), Matrix6d::Zero()};
    odometry.covariance.diagonal() << 1e-8, 1e-8, 2e-5, 4e-5, 4e-5, 1e-8;
    return odometry;
}

}  // namespace hgmm::slam::testing
