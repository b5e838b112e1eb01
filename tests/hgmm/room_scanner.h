#pragma once
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <vector>

#include "hgmm/scan.h"

namespace hgmm::testing {

/// An axis-aligned box, corners in the map frame [m].
using Box = Eigen::AlignedBox3d;

/// A furnished room with a lidar in it: scans whose every point is known in closed form.
struct RoomScanner {
    Box room{Eigen::Vector3d(-4.0, -3.0, 0.0), Eigen::Vector3d(4.0, 3.0, 2.5)};
    std::vector<Box> furniture = {
        {Eigen::Vector3d(-3.9, -2.9, 0.0), Eigen::Vector3d(-3.3, -1.0, 1.9)},  // shelf
        {Eigen::Vector3d(1.0, 1.6, 0.0), Eigen::Vector3d(2.2, 2.4, 0.8)},      // chest
        {Eigen::Vector3d(2.8, -2.5, 0.0), Eigen::Vector3d(3.4, -1.9, 1.2)},    // bin
        {Eigen::Vector3d(-1.6, 2.0, 0.0), Eigen::Vector3d(-1.3, 2.3, 2.5)},    // column
        {Eigen::Vector3d(-2.2, -0.4, 0.0), Eigen::Vector3d(-1.8, 0.2, 0.5)}};  // stool
    int azimuths = 360, elevations = 32;  ///< rays [count]
    double elevationSpan_rad = 1.0;       ///< from -half to +half
    double noiseStd_m = 0.005;            ///< on the range

    /// Distance [m] from `origin`, in free space, to the first surface in unit direction
    /// `u`.
    double range(const Eigen::Vector3d& origin, const Eigen::Vector3d& u) const {
        double nearest = crossing(room, origin, u).second;
        for (const Box& box : furniture) {
            const auto [enter, leave] = crossing(box, origin, u);
            if (enter > 0 && enter < leave) nearest = std::min(nearest, enter);
        }
        return nearest;
    }

    Scan scan(const Pose& T_map_sensor, std::uint64_t seed) const {
        std::mt19937_64 random(seed);
        std::normal_distribution<double> noise(0.0, 1.0);
        Scan result;
        result.T_map_sensor = T_map_sensor;
        for (int e = 0; e < elevations; ++e) {
            const double elevation = elevationSpan_rad * ((e + 0.5) / elevations - 0.5);
            for (int a = 0; a < azimuths; ++a) {
                const double azimuth = 2 * M_PI * a / azimuths;
                const Eigen::Vector3d u(std::cos(elevation) * std::cos(azimuth),
                                        std::cos(elevation) * std::sin(azimuth),
                                        std::sin(elevation));
                const double r =
                    range(T_map_sensor.t, T_map_sensor.R * u) + noiseStd_m * noise(random);
                result.pushBack(float(r * u.x()), float(r * u.y()), float(r * u.z()));
            }
        }
        return result;
    }

 private:
    /// Distances at which the ray's line enters and leaves a box (enter > leave: it does
    /// not).
    static std::pair<double, double> crossing(const Box& box, const Eigen::Vector3d& origin,
                                              const Eigen::Vector3d& u) {
        double enter = -std::numeric_limits<double>::infinity();
        double leave = std::numeric_limits<double>::infinity();
        for (int d = 0; d < 3; ++d) {
            const double a = (box.min()[d] - origin[d]) / u[d];
            const double b = (box.max()[d] - origin[d]) / u[d];
            enter = std::max(enter, std::min(a, b));
            leave = std::min(leave, std::max(a, b));
        }
        return {enter, leave};
    }
};

inline Pose poseAt(double x, double y, double z, double yaw_rad = 0.0) {
    Pose T;
    T.R = Eigen::AngleAxisd(yaw_rad, Eigen::Vector3d::UnitZ()).toRotationMatrix();
    T.t = {x, y, z};
    return T;
}

}  // namespace hgmm::testing
