#pragma once
#include <Eigen/Core>
#include <cstddef>

#include "hgmm/evaluation/occupancy_figures.h"
#include "hgmm/evaluation/points.h"

namespace hgmm::evaluation {

/// Cubes side by side that fill a box of the map.
struct VoxelGrid {
    Eigen::Vector3d min_map = Eigen::Vector3d::Zero();  ///< corner of the first cube [m]
    Eigen::Vector3i count = Eigen::Vector3i::Zero();    ///< cubes along each axis
    double edge_m = 0.05;                               ///< of a cube [m]
};

/// The grid around points but for the outermost share of them at each end of each axis, on
/// multiples of the edge. Throws std::invalid_argument for no points, an edge that is not
/// positive, a share outside [0, 0.5), and more than maxVoxels cubes (saying what edge
/// would do).
VoxelGrid gridAround(const Points& points_map, double edge_m, double outermostShare = 0.005,
                     std::size_t maxVoxels = 50000000);

/// Centres [m, map frame] of the cubes that a map holds occupied, P > 0.5 there and known.
Points occupiedVoxels(const BatchQuery& query, const VoxelGrid& grid);

}  // namespace hgmm::evaluation
