#pragma once
#include <cstddef>
#include <vector>

#include "hgmm/map.h"
#include "hgmm/slam/appearance.h"

namespace hgmm::slam {

/// When the next submap begins: after a share of the range that the sensor typically sees,
/// so that rooms get small submaps and courtyards large ones, or after a turn.
struct SubmapParams {
    double lengthPerRange = 0.5;  ///< way of the robot per median range [m/m], > 0
    double minLength_m = 0.5;     ///< [m], > 0
    double maxLength_m = 10.0;    ///< [m], >= minLength_m
    double maxTurn_rad = 1.2;     ///< sum of turns [rad], > 0
    int minScans = 5;             ///< also for loop closures to be looked for [count], >= 1

    /// Throws std::invalid_argument naming the field.
    void validate() const;
};

/// A piece of the way: the map of a few scans, in a frame of its own.
struct Submap {
    explicit Submap(const MapParams& params) : map(params) {}

    Map map;  ///< in the submap's frame, whose origin is where the robot began
    /// Where the robot was at each scan.
    std::vector<Pose> T_submap_robot;
    /// Where the sensor was at the first scan in the map [m].
    Eigen::Vector3d sensor_submap = Eigen::Vector3d::Zero();
    double length_m = 0.0;  ///< of the way in it [m]
    double turn_rad = 0.0;  ///< sum of turns [rad]
};

/// What closures look at in a finished submap.
struct SubmapShape {
    explicit SubmapShape(const Submap& submap);

    /// Components of as many hits as make a surface, about kMost evenly over all.
    Mixture<3> surfaces_submap;
    Eigen::Vector3d centre_submap = Eigen::Vector3d::Zero();  ///< of the means [m]
    double radius_m = 0.0;  ///< of nine tenths of the means about it [m]
    Appearance appearance;

    static constexpr std::size_t kMost = 2000;  ///< components [count]
};

/// The base level of a map as it lies in the map's frame.
Mixture<3> surfacesInMapFrame(const Map& map);

}  // namespace hgmm::slam
