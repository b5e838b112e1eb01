#pragma once
#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "hgmm/evaluation/points.h"
#include "hgmm/map.h"

namespace hgmm::evaluation {

/// An exact measurement.
struct Ray {
    Eigen::Vector3d origin_map;  ///< [m]
    Eigen::Vector3d hit_map;     ///< [m]
};

/// The empty box room, its walls along the axes of the map, that all hits of noiseless rays
/// are on: the box around them. Throws std::invalid_argument unless at least 99.9 % of the
/// hits are within 1 cm of one of its walls and all origins are inside.
Box roomOf(const std::vector<Ray>& rays);

/// Answers of a map of a box room where the truth is known in closed form.
struct RoomFigures {
    static constexpr double kBeforeWalls_m = 0.1;  ///< free points are farther from each
    static constexpr double kBehind_m[2] = {0.5, 10.0};  ///< of hidden points, at right
                                                         ///< angles to the wall

    std::size_t wallPoints = 0, freePoints = 0, hiddenPoints = 0;  ///< asked for
    double wallOccupied = 0.0;     ///< share of hits with P(occ) > 0.5
    double freeNotOccupied = 0.0;  ///< share of free points with P(occ) < 0.5
    double hiddenUnknown = 0.0;    ///< share of hidden points with P(unknown) > 0.5
    double freeUnknown = 0.0;      ///< share of free points with P(unknown) > 0.5
};

/// Asks for the hits, for kFreePerRay points on each ray, evenly drawn, that are in the
/// room, and for one on the continuation of each ray behind its wall.
/// @param rays of noiseless scans that did not build the map; at least one
RoomFigures evaluateRoom(const Map& map, const std::vector<Ray>& rays, const Box& room,
                         std::uint64_t seed);

}  // namespace hgmm::evaluation
