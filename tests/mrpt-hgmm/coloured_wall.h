#pragma once
#include <mrpt/maps/CColouredPointsMap.h>
#include <mrpt/maps/CHGMMOccupancyMap.h>
#include <mrpt/maps/CPointsMapXYZI.h>
#include <mrpt/obs/CObservationPointCloud.h>
#include <mrpt/poses/CPose3D.h>

#include <Eigen/Core>
#include <string>
#include <vector>

/// A wall 3 m before a sensor at (100, 0, 1), whose colours are known in closed form.
namespace coloured_wall {

inline const mrpt::poses::CPose3D kSensor(100, 0, 1, 0, 0, 0);

/// Red on the left and blue-green on the right, with a sharp edge; green rises with height.
inline Eigen::Vector3d colourAt(double y, double z) {
    const bool left = y > 0;
    return {left ? 0.9 : 0.1, 0.3 + 0.2 * z, left ? 0.2 : 0.8};
}

/// Calls visit(x, y, z) for the points in the sensor frame.
template <typename Visitor>
void forEachPoint(Visitor&& visit) {
    for (int i = 0; i < 100; ++i)
        for (int k = 0; k < 100; ++k) visit(3.F, -0.99F + 0.02F * i, -0.99F + 0.02F * k);
}

inline mrpt::obs::CObservationPointCloud::Ptr colours() {
    auto points = mrpt::maps::CColouredPointsMap::Create();
    forEachPoint([&](float x, float y, float z) {
        const Eigen::Vector3f c = colourAt(y, z).cast<float>();
        points->insertPointRGB(x, y, z, c[0], c[1], c[2]);
    });
    auto o = mrpt::obs::CObservationPointCloud::Create();
    o->pointcloud = points;
    return o;
}

/// The red of the same wall as intensity in 8 bits.
inline mrpt::obs::CObservationPointCloud::Ptr intensities() {
    auto points = mrpt::maps::CPointsMapXYZI::Create();
    forEachPoint([&](float x, float y, float z) {
        points->insertPointRGB(x, y, z, static_cast<float>(255 * colourAt(y, z)[0]), 0, 0);
    });
    auto o = mrpt::obs::CObservationPointCloud::Create();
    o->pointcloud = points;
    return o;
}

inline mrpt::maps::CHGMMOccupancyMap map(std::vector<std::string> modalities = {"r", "g",
                                                                                "b"}) {
    mrpt::maps::CHGMMOccupancyMap map;
    map.insertionOptions.params.modalities = std::move(modalities);
    map.insertObservation(*colours(), kSensor);
    return map;
}

/// A point of the wall in the map frame [m].
inline Eigen::Vector3d onWall(double y, double z) {
    return {103, y, 1 + z};
}

}  // namespace coloured_wall
