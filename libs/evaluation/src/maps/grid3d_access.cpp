#include "maps/grid3d_access.h"

#include <mrpt/maps/CSimplePointsMap.h>

#include <algorithm>

namespace hgmm::evaluation {

void insertIntoGrid(const Points& points_map, const Eigen::Vector3d& origin_map,
                    mrpt::maps::COccupancyGridMap3D& grid) {
    mrpt::maps::CSimplePointsMap cloud;
    cloud.reserve(points_map.size());
    for (const Eigen::Vector3d& p_map : points_map)
        cloud.insertPointFast(static_cast<float>(p_map.x()), static_cast<float>(p_map.y()),
                              static_cast<float>(p_map.z()));
    grid.insertPointCloud({origin_map.x(), origin_map.y(), origin_map.z()}, cloud);
}

Answer answerOfGrid(const mrpt::maps::COccupancyGridMap3D& grid,
                    const Eigen::Vector3d& p_map) {
    const auto& g = grid.m_grid;
    // The grid's own conversion to indices rounds towards zero, and so takes what is less
    // than one voxel below its borders for inside.
    const bool inside = p_map.x() >= g.getXMin() && p_map.x() < g.getXMax() &&
                        p_map.y() >= g.getYMin() && p_map.y() < g.getYMax() &&
                        p_map.z() >= g.getZMin() && p_map.z() < g.getZMax();
    if (!inside) return {};
    const auto* voxel = g.cellByPos(p_map.x(), p_map.y(), p_map.z());
    if (voxel == nullptr || *voxel == 0) return {};
    const double freeness = mrpt::maps::COccupancyGridMap3D::l2p(*voxel);
    return {std::clamp(1.0 - freeness, 0.0, 1.0), false};
}

std::size_t bytesOfGrid(const mrpt::maps::COccupancyGridMap3D& grid) {
    return grid.m_grid.getVoxelCount() * sizeof(mrpt::maps::COccupancyGridMap3D::voxelType);
}

}  // namespace hgmm::evaluation
