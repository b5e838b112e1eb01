#pragma once
#include <mrpt/maps/COccupancyGridMap3D.h>

#include "hgmm/evaluation/baseline.h"

namespace hgmm::evaluation {

/// Inserts rays from one origin [m]. The grid keeps its size: what is beyond it is lost.
void insertIntoGrid(const Points& points_map, const Eigen::Vector3d& origin_map,
                    mrpt::maps::COccupancyGridMap3D& grid);

/// What a grid says of a point. A voxel at exactly even odds is taken for untouched, which
/// is all that the grid itself can tell.
Answer answerOfGrid(const mrpt::maps::COccupancyGridMap3D& grid,
                    const Eigen::Vector3d& p_map);

/// Of all voxels [bytes].
std::size_t bytesOfGrid(const mrpt::maps::COccupancyGridMap3D& grid);

}  // namespace hgmm::evaluation
