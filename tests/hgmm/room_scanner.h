#pragma once
#include <Eigen/Geometry>
#include <cmath>
#include <limits>
#include <random>

#include "hgmm/scan.h"

namespace hgmm::testing {

/// A box-shaped room with a lidar in it: scans whose every point is known in closed form.
struct RoomScanner {
    Eigen::Vector3d low{-4.0, -3.0, 0.0};   ///< corner of the room, map frame [m]
    Eigen::Vector3d high{4.0, 3.0, 2.5};    ///< opposite corner, map frame [m]
    int azimuths = 360, elevations = 32;    ///< rays [count]
    double elevationSpan_rad = 1.0;         ///< from -half to +half
    double noiseStd_m = 0.005;              ///< on the range

    /// Distance [m] from `origin` inside the room to the wall in unit direction `direction`.
    double range(const Eigen::Vector3d& origin, const Eigen::Vector3d& direction) const {
        double nearest = std::numeric_limits<double>::infinity();
        for (int d = 0; d < 3; ++d) {
            if (direction[d] == 0) continue;
            const double wall = direction[d] > 0 ? high[d] : low[d];
            nearest = std::min(nearest, (wall - origin[d]) / direction[d]);
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
};

inline Pose poseAt(double x, double y, double z, double yaw_rad = 0.0) {
    Pose T;
    T.R = Eigen::AngleAxisd(yaw_rad, Eigen::Vector3d::UnitZ()).toRotationMatrix();
    T.t = {x, y, z};
    return T;
}

}  // namespace hgmm::testing
