#pragma once
#include <hgmm/map.h>

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <algorithm>
#include <optional>
#include <vector>

namespace planner {

using Path = std::vector<Eigen::Vector3d>;  ///< places of the robot's centre in the map [m]

/// A sphere; in the map of a planar laser, a disc at the laser's height.
struct Robot {
    double radius_m = 0.2;  ///< [m], > 0
    /// Hits may be so far off the map's surfaces [m], >= 0.
    double margin_m = 0.04;
    /// More probable collisions with a surface block the way, in (0, 0.5].
    double maxProbability = 0.001;
    /// Surfaces that are farther from the centre cost nothing [m].
    double comfort_m = 0.6;
    hgmm::UnknownSpace unknown = hgmm::UnknownSpace::occupied;
    std::optional<double> plane_m;  ///< height of the planar laser in the map [m]

    bool planar() const { return plane_m.has_value(); }
    /// Distance of the places within it that are asked whether they are unknown [m].
    double unknownSpacing_m() const { return std::max(1e-3, 0.5 * radius_m); }
};

/// Where a robot may be, as a map says.
class FreeSpace {
 public:
    FreeSpace(const hgmm::Map& map, const Robot& robot) : map_(map), robot_(robot) {}

    const Robot& robot() const { return robot_; }
    /// Box around all surfaces; in a plane, flat.
    Eigen::AlignedBox3d bounds_map() const;

    /// Whether the robot can go from one place to the other along a line, or be there.
    bool isFree(const Eigen::Vector3d& from_map, const Eigen::Vector3d& to_map) const;

    /// To the nearest surface, from the robot's centre.
    hgmm::SurfaceDistance distance(const Eigen::Vector3d& centre_map,
                                   const hgmm::DistanceParams& params = {}) const;
    /// The same if it is within comfort_m: what nearness() needs.
    hgmm::SurfaceDistance nearDistance(const Eigen::Vector3d& centre_map) const {
        return distance(centre_map, {robot_.comfort_m});
    }
    /// Least distance [m] of places along a path, 1 cm apart.
    double clearance_m(const Path& path_map) const;

    /// Cost of a surface at a distance, for each metre of the way: 0 from comfort_m on.
    double nearness(double distance_m) const;
    double nearnessSlope(double distance_m) const;      ///< [1/m], <= 0
    double nearnessCurvature(double distance_m) const;  ///< [1/m^2], >= 0

 private:
    bool reachesUnknown(const hgmm::Capsule& body_map) const;

    const hgmm::Map& map_;
    Robot robot_;
};

double length_m(const Path& path_map);

/// The same path with places at most `spacing_m` apart.
Path subdivided(const Path& path_map, double spacing_m);

}  // namespace planner
