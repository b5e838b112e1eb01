#pragma once
#include <mrpt/maps/CColouredPointsMap.h>
#include <mrpt/maps/CPointsMapXYZI.h>

#include "../evaluation/box_room.h"

/// The box room with painted walls: colours and intensities are known in closed form.
namespace coloured_room {

/// Of a point of the walls; blue is what red and green leave.
inline Eigen::Vector3d colourAt(const Eigen::Vector3d& p_map) {
    const double r = 0.5 + 0.1 * p_map.x(), g = p_map.y() > 0 ? 0.8 : 0.2;
    return {r, g, 1 - 0.5 * (r + g)};
}

/// The recording of box_room with another cloud in each scan: insert(cloud, point in the
/// sensor frame, its colour) fills it.
template <typename Cloud, typename Insert>
box_room::Entries repainted(std::size_t scans, std::size_t pointsPerScan, Insert insert) {
    box_room::Entries entries;
    for (std::size_t i = 0; i < scans; ++i) {
        const auto pose = box_room::robotPose(i);
        const auto o = box_room::pointCloud(pose, box_room::timeOfScan(i), pointsPerScan);
        const auto T_map_sensor = pose + o->sensorPose;
        auto cloud = Cloud::Create();
        for (std::size_t k = 0; k < o->pointcloud->size(); ++k) {
            mrpt::math::TPoint3D p;
            o->pointcloud->getPoint(k, p.x, p.y, p.z);
            const auto p_map = T_map_sensor.composePoint(p);
            insert(*cloud, p, colourAt({p_map.x, p_map.y, p_map.z}));
        }
        o->pointcloud = cloud;
        entries.push_back(o);
    }
    return entries;
}

inline box_room::Entries withColours(std::size_t scans, std::size_t pointsPerScan) {
    return repainted<mrpt::maps::CColouredPointsMap>(
        scans, pointsPerScan,
        [](auto& cloud, const mrpt::math::TPoint3D& p, const Eigen::Vector3d& c) {
            cloud.insertPointRGB(float(p.x), float(p.y), float(p.z), float(c[0]),
                                 float(c[1]), float(c[2]));
        });
}

/// Red as intensity, in 8 bits.
inline box_room::Entries withIntensities(std::size_t scans, std::size_t pointsPerScan) {
    return repainted<mrpt::maps::CPointsMapXYZI>(
        scans, pointsPerScan,
        [](auto& cloud, const mrpt::math::TPoint3D& p, const Eigen::Vector3d& c) {
            cloud.insertPointRGB(float(p.x), float(p.y), float(p.z), float(255 * c[0]), 0,
                                 0);
        });
}

}  // namespace coloured_room
