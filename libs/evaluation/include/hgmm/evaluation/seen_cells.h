#pragma once
#include <Eigen/Core>
#include <bitset>
#include <cstddef>

#include "hgmm/evaluation/voxel_hash.h"
#include "hgmm/scan.h"

namespace hgmm::evaluation {

/// The cells of a regular grid that any ray passed or ended in: what can be known at all.
class SeenCells {
 public:
    /// How far from its cell a ray makes space seen, along each axis [cell].
    static constexpr int kReach = 2;

    /// @param edge_m of a cell [m], > 0
    explicit SeenCells(double edge_m) : edge_m_(edge_m) {}

    /// Marks the cells of the rays of a scan, to their hits and along cleared rays; points
    /// that are not finite are left out. Of hits in the same quarter of a cell's edge,
    /// along each axis, one stands for all, for dense images would take longer to trace
    /// than to map.
    void add(const Scan& scan);
    /// Marks the cells of one ray, both ends included.
    void addRay(const Eigen::Vector3d& from_map, const Eigen::Vector3d& to_map);

    /// Whether no ray came within kReach cells of the point's cell.
    bool isUnseen(const Eigen::Vector3d& point_map) const;

    double edge_m() const { return edge_m_; }
    /// Cells marked.
    std::size_t size() const;

 private:
    static constexpr int kBits = 3, kSide = 1 << kBits;  ///< of a block of cells
    using Block = std::bitset<kSide * kSide * kSide>;

    static VoxelIndex blockOf(const VoxelIndex& cell);
    static std::size_t bitOf(const VoxelIndex& cell);
    void mark(const VoxelIndex& cell);
    bool isMarked(const VoxelIndex& cell) const;

    double edge_m_;
    VoxelHash<Block> blocks_;
    VoxelHash<char> ends_;  ///< of the rays of one scan, in quarters of an edge
    VoxelIndex lastBlock_ = VoxelIndex::Constant(1 << 30);
    std::size_t lastNumber_ = 0;  ///< of lastBlock_ in blocks_
};

/// The edge of cells that suits a recording: 5 cm, or 15 cm where half of the ranges of a
/// scan exceed 6 m, as of lidars outdoors [m].
double seenCellEdge_m(const Scan& scan);

}  // namespace hgmm::evaluation
