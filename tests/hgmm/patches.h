#pragma once
#include <Eigen/Geometry>
#include <cmath>
#include <random>

#include "hgmm/mixture.h"
#include "hgmm/scan.h"
#include "registration/registration_cost.h"

namespace hgmm::testing {

constexpr double kDegree = M_PI / 180.0;

inline double unitUniform(std::mt19937_64& random) {
    return double(random() >> 11U) * 0x1p-53;
}

inline double normal(std::mt19937_64& random) {
    return std::sqrt(-2.0 * std::log(1.0 - unitUniform(random))) *
           std::cos(2.0 * M_PI * unitUniform(random));
}

inline Eigen::Vector3d direction(std::mt19937_64& random) {
    return Eigen::Vector3d(normal(random), normal(random), normal(random)).normalized();
}

/// Off by so much, in a random direction.
inline Pose displaced(const Pose& T, double position_m, double angle_rad,
                      std::mt19937_64& random) {
    return {rotationOf(angle_rad * direction(random)) * T.R,
            T.t + position_m * direction(random)};
}

/// Error (w, v) of a pose: truth = { exp(w) R, t + v }.
inline Vector6d errorOf(const Pose& estimate, const Pose& truth) {
    const Eigen::AngleAxisd turn(truth.R * estimate.R.transpose());
    Vector6d error;
    error << turn.angle() * turn.axis(), truth.t - estimate.t;
    return error;
}

/// A patch of a surface, `edge_m` wide and 5 mm thick.
inline Gaussian<3> patch(const Eigen::Vector3d& mean, const Eigen::Vector3d& normal,
                         double edge_m) {
    Gaussian<3> g;
    g.support = 50;
    g.mean = mean;
    const Eigen::Vector3d n = normal.normalized();
    g.covariance =
        edge_m * edge_m / 12 * (Eigen::Matrix3d::Identity() - n * n.transpose()) +
        0.005 * 0.005 * n * n.transpose();
    return g;
}

/// Patches of a rectangle about `centre`, spanned by two axes of half lengths `a` and `b`,
/// moved at random by up to half their distance along it, so that no two tilings agree.
inline void tile(const Eigen::Vector3d& centre, const Eigen::Vector3d& a,
                 const Eigen::Vector3d& b, double edge_m, std::mt19937_64& random,
                 Mixture<3>& mixture) {
    const Eigen::Vector3d ua = a.normalized(), ub = b.normalized();
    for (double x = -a.norm() + edge_m / 2; x < a.norm(); x += edge_m)
        for (double y = -b.norm() + edge_m / 2; y < b.norm(); y += edge_m) {
            // Drawn one after the other, so that all compilers see the same scene.
            const double alongA = x + edge_m * (unitUniform(random) - 0.5);
            const double alongB = y + edge_m * (unitUniform(random) - 0.5);
            mixture.pushBack(
                patch(centre + alongA * ua + alongB * ub, ua.cross(ub), edge_m));
        }
}

/// Floor and three pairs of walls of unequal sizes.
inline Mixture<3> roomOfPatches(std::uint64_t seed, double edge_m = 0.4) {
    std::mt19937_64 random(seed);
    const Eigen::Vector3d x = Eigen::Vector3d::UnitX(), y = Eigen::Vector3d::UnitY(),
                          z = Eigen::Vector3d::UnitZ();
    Mixture<3> mixture;
    tile({0, 0, 0}, 4 * x, 3 * y, edge_m, random, mixture);
    tile({4, 0, 1.2}, 3 * y, 1.2 * z, edge_m, random, mixture);
    tile({-4, -1, 1.2}, 2 * y, 1.2 * z, edge_m, random, mixture);
    tile({0, 3, 1.2}, 4 * x, 1.2 * z, edge_m, random, mixture);
    tile({1, -3, 1.2}, 3 * x, 1.2 * z, edge_m, random, mixture);
    return mixture;
}

inline Mixture<3> plane(std::uint64_t seed) {
    std::mt19937_64 random(seed);
    Mixture<3> mixture;
    tile({0, 0, 0}, Eigen::Vector3d(4, 0, 0), Eigen::Vector3d(0, 4, 0), 0.4, random,
         mixture);
    return mixture;
}

/// The pose at which tests look from into their target.
inline Pose somePose() {
    return {rotationOf({0.1, -0.2, 0.7}), {0.6, -0.3, 0.9}};
}

/// The mixture as seen from a pose.
inline Mixture<3> seenFrom(const Pose& T_target_source, const Mixture<3>& mixture) {
    return transformed(mixture, T_target_source.inverse());
}

}  // namespace hgmm::testing
