#pragma once
#include <Eigen/Core>
#include <limits>

#include "hgmm/evaluation/baseline.h"
#include "hgmm/evaluation/split.h"

/// A wall seen from one place, in reach of hand calculation.
namespace wall_scene {

constexpr double kWall_m = 3.03;  ///< x of the wall in the map frame, amid a voxel of 10 cm

/// Where the sensor is.
inline Eigen::Vector3d origin_map() {
    return {1.03, 0.53, 0.73};
}

/// Appends a point of the map frame to a scan by the sensor at origin_map(), which is
/// turned by 90 degrees about z.
inline void addPoint(hgmm::Scan& scan, const Eigen::Vector3d& p_map) {
    scan.T_map_sensor.R << 0, -1, 0, 1, 0, 0, 0, 0, 1;
    scan.T_map_sensor.t = origin_map();
    const Eigen::Vector3f p_sensor =
        (scan.T_map_sensor.R.transpose() * (p_map - origin_map())).cast<float>();
    scan.pushBack(p_sensor.x(), p_sensor.y(), p_sensor.z());
}

/// n rays into one point, by default that of the wall straight before the sensor.
inline hgmm::Scan rays(std::size_t n,
                       const Eigen::Vector3d& p_map = {kWall_m, 0.53, 0.73}) {
    hgmm::Scan scan;
    for (std::size_t i = 0; i < n; ++i) addPoint(scan, p_map);
    return scan;
}

/// 101 x 101 rays to a wall of 2 x 2 m.
inline hgmm::Scan wallScan() {
    hgmm::Scan scan;
    for (int i = -50; i <= 50; ++i)
        for (int j = -50; j <= 50; ++j)
            addPoint(scan, {kWall_m, 0.53 + 0.02 * i, 0.73 + 0.02 * j});
    return scan;
}

/// Points in a box that all maps here see: [0, 1) m on each axis.
inline hgmm::evaluation::Points randomPoints(std::size_t n, std::uint64_t seed) {
    std::mt19937_64 stream(seed);
    hgmm::evaluation::Points points;
    for (std::size_t i = 0; i < n; ++i) {
        const double x = hgmm::evaluation::nextUniform(stream);
        const double y = hgmm::evaluation::nextUniform(stream);
        points.emplace_back(x, y, hgmm::evaluation::nextUniform(stream));
    }
    return points;
}

/// Appends what a broken sensor gives.
inline void addHostilePoints(hgmm::Scan& scan) {
    constexpr float kInfinity = std::numeric_limits<float>::infinity();
    scan.pushBack(std::numeric_limits<float>::quiet_NaN(), 0, 0);
    scan.pushBack(0, kInfinity, 0);
    scan.pushBack(0, 0, -kInfinity);
}

inline hgmm::evaluation::Answer ask(const hgmm::evaluation::Baseline& map,
                                    const Eigen::Vector3d& p_map) {
    hgmm::evaluation::Answer answer;
    map.query(&p_map, 1, &answer);
    return answer;
}

/// On the line straight before the sensor, unless told otherwise.
inline hgmm::evaluation::Answer ask(const hgmm::evaluation::Baseline& map, double x,
                                    double y = 0.53, double z = 0.73) {
    return ask(map, Eigen::Vector3d(x, y, z));
}

}  // namespace wall_scene
