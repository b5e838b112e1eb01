#pragma once
#include <mrpt/maps/CHGMMOccupancyMap.h>
#include <mrpt/maps/CSimplePointsMap.h>
#include <mrpt/obs/CObservationPointCloud.h>
#include <mrpt/poses/CPose3D.h>

#include <algorithm>
#include <cmath>
#include <random>

/// A box room, seen by a 3D lidar from its middle: what is wall, free or never seen is
/// known in closed form.
namespace lit_room {

inline const Eigen::Vector3d kHalf_m(3.0, 2.0, 1.25);  ///< inner half lengths of the room
/// Of the room [m]; no wall lies on the border of cells of 10 or 20 cm.
inline const Eigen::Vector3d kMiddle_map(101.05, -52.05, 4.0);

/// Distance of a point to the nearest wall [m], negative behind it.
inline double depthInside(const Eigen::Vector3d& point_map) {
    return (kHalf_m - (point_map - kMiddle_map).cwiseAbs()).minCoeff();
}

/// Rays evenly over the sphere from `offset` off the middle, ranges with noise of 1 cm.
inline mrpt::obs::CObservationPointCloud::Ptr scan(const Eigen::Vector3d& offset,
                                                   unsigned seed, int rays = 6000) {
    std::mt19937 random(seed);
    std::normal_distribution<double> noise_m(0.0, 0.01);
    auto cloud = mrpt::maps::CSimplePointsMap::Create();
    for (int i = 0; i < rays; ++i) {
        const double z = 1.0 - 2.0 * (i + 0.5) / rays, angle = 2.399963229728653 * i;
        const double r = std::sqrt(1 - z * z);
        const Eigen::Vector3d u(r * std::cos(angle), r * std::sin(angle), z);
        double range = 1e9;
        for (int d = 0; d < 3; ++d)
            range = std::min(range, (std::copysign(kHalf_m[d], u[d]) - offset[d]) / u[d]);
        const Eigen::Vector3f p = ((range + noise_m(random)) * u).cast<float>();
        cloud->insertPoint(p.x(), p.y(), p.z());
    }
    auto observation = mrpt::obs::CObservationPointCloud::Create();
    observation->pointcloud = cloud;
    return observation;
}

/// The room after six scans, inserted through the plugin.
inline mrpt::maps::CHGMMOccupancyMap map() {
    mrpt::maps::CHGMMOccupancyMap map;
    for (unsigned k = 0; k < 6; ++k) {
        const Eigen::Vector3d offset(0.5 * std::cos(k), 0.4 * std::sin(k), 0.1 * k - 0.3);
        const Eigen::Vector3d at = kMiddle_map + offset;
        map.insertObservation(*scan(offset, k),
                              mrpt::poses::CPose3D(at.x(), at.y(), at.z(), 0, 0, 0));
    }
    return map;
}

}  // namespace lit_room
