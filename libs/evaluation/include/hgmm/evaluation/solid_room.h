#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "hgmm/evaluation/points.h"
#include "hgmm/evaluation/scene.h"
#include "hgmm/scan.h"

/// A room of 12 x 8 x 3 m from the origin with solid boxes and pillars, whose insides, like
/// the space behind the walls, no ray can pass.
namespace hgmm::evaluation::solid_room {

/// Walls, boxes of .2, .5 and 1.2 m edge and pillars of .1, .15 and .2 m radius, from the
/// floor to the ceiling.
Scene room();

/// Points of one kind that no ray can come near.
struct HiddenPoints {
    std::string kind;
    Points points_map;  ///< [m]
};

/// Of each kind up to `n` points: inside the boxes of each size and inside the pillars, .04
/// m and more from their faces; .15 to 1.6 m behind walls; beyond corners, as far from both
/// walls' planes.
/// @param height_m all points are at this height; in (0, 3), or 0 for any [m]
std::vector<HiddenPoints> hiddenPoints(std::size_t n, double height_m, std::uint64_t seed);

/// How the robot moves.
enum class Route {
    round,   ///< on an ellipse along the walls, looking to the middle
    through  ///< in a curve from one end to the other, looking ahead
};

/// Poses of the sensor, 1 m above the floor, evenly along a route.
std::vector<Pose> poses(Route route, int scans);

}  // namespace hgmm::evaluation::solid_room
