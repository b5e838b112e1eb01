#pragma once
#include <Eigen/Core>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace hgmm::evaluation {

/// A cell of a regular grid without borders: cell i covers [i, i + 1) edges on each axis.
using VoxelIndex = Eigen::Vector3i;

/// Whether a point is finite and its cell can be numbered, with room for neighbours.
inline bool hasVoxel(const Eigen::Vector3d& p_m, double edge_m) {
    constexpr double kLargest = 1 << 30;
    return (p_m.array().abs() < kLargest * edge_m).all();  // false for NaN, too
}

/// The cell of a point that hasVoxel().
inline VoxelIndex voxelOf(const Eigen::Vector3d& p_m, double edge_m) {
    return {static_cast<int>(std::floor(p_m.x() / edge_m)),
            static_cast<int>(std::floor(p_m.y() / edge_m)),
            static_cast<int>(std::floor(p_m.z() / edge_m))};
}

/// Centre of a cell [m].
inline Eigen::Vector3d centreOf(const VoxelIndex& v, double edge_m) {
    return (v.cast<double>().array() + 0.5).matrix() * edge_m;
}

/// Cells by index: an open-addressing table of numbers into one array of cells, which are
/// in the order they were made, so that all results are the same from run to run.
template <class Cell>
class VoxelHash {
 public:
    std::size_t size() const { return cells_.size(); }
    VoxelIndex index(std::size_t i) const { return indices_[i]; }
    Cell& cell(std::size_t i) { return cells_[i]; }
    const Cell& cell(std::size_t i) const { return cells_[i]; }

    /// The cell's contents, or null if it was never made.
    const Cell* find(const VoxelIndex& v) const {
        if (slots_.empty()) return nullptr;
        const std::uint32_t number = slots_[slotOf(v)];
        return number == kEmpty ? nullptr : &cells_[number];
    }

    /// Number of the cell, which is made if need be: for cell() and index().
    std::size_t numberOf(const VoxelIndex& v) {
        if (2 * (cells_.size() + 1) > slots_.size()) grow();
        std::uint32_t& number = slots_[slotOf(v)];
        if (number == kEmpty) {
            number = static_cast<std::uint32_t>(cells_.size());
            indices_.push_back(v);
            cells_.emplace_back();
        }
        return number;
    }

    void clear() {
        indices_.clear();
        cells_.clear();
        slots_.assign(slots_.size(), kEmpty);
    }

    /// Of cells, indices and table [bytes]; of what is in use, not of reserves.
    std::size_t bytes() const {
        return cells_.size() * (sizeof(Cell) + sizeof(VoxelIndex)) +
               slots_.size() * sizeof(std::uint32_t);
    }

 private:
    static constexpr std::uint32_t kEmpty = 0xFFFFFFFFU;

    std::vector<VoxelIndex> indices_;
    std::vector<Cell> cells_;
    std::vector<std::uint32_t> slots_;  ///< cell numbers; its size is a power of two

    /// Where v is, or would be put.
    std::size_t slotOf(const VoxelIndex& v) const {
        // Any odd constants do; the last rounds bring the high bits down to the mask's.
        std::uint64_t h = 0x9E3779B97F4A7C15ULL * static_cast<std::uint32_t>(v.x());
        h = (h ^ (h >> 29)) + 0xC2B2AE3D27D4EB4FULL * static_cast<std::uint32_t>(v.y());
        h = (h ^ (h >> 31)) + 0x165667B19E3779F9ULL * static_cast<std::uint32_t>(v.z());
        h *= 0xBF58476D1CE4E5B9ULL;
        std::size_t slot = (h ^ (h >> 32)) & (slots_.size() - 1);
        while (slots_[slot] != kEmpty && indices_[slots_[slot]] != v)
            slot = (slot + 1) & (slots_.size() - 1);
        return slot;
    }

    void grow() {
        slots_.assign(slots_.empty() ? 64 : 2 * slots_.size(), kEmpty);
        for (std::size_t i = 0; i < cells_.size(); ++i)
            slots_[slotOf(indices_[i])] = static_cast<std::uint32_t>(i);
    }
};

}  // namespace hgmm::evaluation
