#include "hgmm/evaluation/seen_cells.h"

#include <cmath>
#include <vector>

#include "hgmm/evaluation/timing.h"
#include "hgmm/evaluation/voxel_traversal.h"

namespace hgmm::evaluation {

VoxelIndex SeenCells::blockOf(const VoxelIndex& cell) {
    return {cell.x() >> kBits, cell.y() >> kBits, cell.z() >> kBits};
}

std::size_t SeenCells::bitOf(const VoxelIndex& cell) {
    constexpr int mask = kSide - 1;
    return static_cast<std::size_t>(((cell.z() & mask) << (2 * kBits)) |
                                    ((cell.y() & mask) << kBits) | (cell.x() & mask));
}

void SeenCells::mark(const VoxelIndex& cell) {
    const VoxelIndex block = blockOf(cell);
    // Neighbours along a ray are mostly in the same block.
    if (block != lastBlock_) {
        lastNumber_ = blocks_.numberOf(block);
        lastBlock_ = block;
    }
    blocks_.cell(lastNumber_).set(bitOf(cell));
}

bool SeenCells::isMarked(const VoxelIndex& cell) const {
    const Block* block = blocks_.find(blockOf(cell));
    return block != nullptr && block->test(bitOf(cell));
}

void SeenCells::addRay(const Eigen::Vector3d& from_map, const Eigen::Vector3d& to_map) {
    if (!hasVoxel(from_map, edge_m_) || !hasVoxel(to_map, edge_m_)) return;
    traverseVoxels(from_map, to_map, edge_m_, [&](const VoxelIndex& cell) { mark(cell); });
    mark(voxelOf(to_map, edge_m_));
}

void SeenCells::add(const Scan& scan) {
    constexpr double kQuarter = 0.25;
    const Pose& T = scan.T_map_sensor;
    ends_.clear();
    for (std::size_t i = 0; i < scan.size(); ++i) {
        const Eigen::Vector3d p_map =
            T.R * Eigen::Vector3d(scan.x[i], scan.y[i], scan.z[i]) + T.t;
        if (!hasVoxel(p_map, kQuarter * edge_m_)) continue;
        const std::size_t before = ends_.size();
        ends_.numberOf(voxelOf(p_map, kQuarter * edge_m_));
        if (ends_.size() > before) addRay(T.t, p_map);
    }
    for (const ClearedRay& ray : scan.clearedRays)
        addRay(T.t, T.R * (ray.length_m * ray.direction).cast<double>() + T.t);
}

bool SeenCells::isUnseen(const Eigen::Vector3d& point_map) const {
    if (!hasVoxel(point_map, edge_m_)) return true;
    const VoxelIndex cell = voxelOf(point_map, edge_m_);
    for (int dx = -kReach; dx <= kReach; ++dx)
        for (int dy = -kReach; dy <= kReach; ++dy)
            for (int dz = -kReach; dz <= kReach; ++dz)
                if (isMarked(cell + VoxelIndex(dx, dy, dz))) return false;
    return true;
}

std::size_t SeenCells::size() const {
    std::size_t marked = 0;
    for (std::size_t i = 0; i < blocks_.size(); ++i) marked += blocks_.cell(i).count();
    return marked;
}

double seenCellEdge_m(const Scan& scan) {
    constexpr double kFar_m = 6.0, kIndoors_m = 0.05, kOutdoors_m = 0.15;
    std::vector<double> ranges_m;
    for (std::size_t i = 0; i < scan.size(); ++i) {
        const double range_m = std::hypot(scan.x[i], scan.y[i], scan.z[i]);
        if (std::isfinite(range_m)) ranges_m.push_back(range_m);
    }
    return median(std::move(ranges_m)) > kFar_m ? kOutdoors_m : kIndoors_m;
}

}  // namespace hgmm::evaluation
