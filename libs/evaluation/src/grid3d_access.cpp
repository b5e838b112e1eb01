#include "grid3d_access.h"

#include <mrpt/maps/CSimplePointsMap.h>

#include <algorithm>

#include "scan_points.h"

namespace hgmm::evaluation {

void insertIntoGrid(const Scan& scan, mrpt::maps::COccupancyGridMap3D& grid) {
    const Points points = finitePointsInMap(scan);
    mrpt::maps::CSimplePointsMap cloud;
    cloud.reserve(points.size());
    for (const Eigen::Vector3d& p_map : points)
        cloud.insertPointFast(static_cast<float>(p_map.x()), static_cast<float>(p_map.y()),
                              static_cast<float>(p_map.z()));
    const Eigen::Vector3d& t = scan.T_map_sensor.t;
    grid.insertPointCloud({t.x(), t.y(), t.z()}, cloud);
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
