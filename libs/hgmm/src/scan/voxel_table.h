#pragma once
#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cstdint>
#include <utility>
#include <vector>

#include "hgmm/scan.h"
#include "scan/leaf_keys.h"

namespace hgmm {

/// What is summed over the points of one leaf, about its first point (the anchor) so that
/// sums keep their digits far from the sensor.
template <typename Sums>
struct Leaf {
    std::uint64_t key = 0;
    std::array<float, 3> anchor{};
    Sums sums;
};

/// Open-addressing table from leaf key to leaf, in order of first appearance.
template <typename Sums>
class VoxelTable {
 public:
    explicit VoxelTable(std::size_t points) {
        std::size_t slots = 1024;
        while (slots < points / 8) slots *= 2;
        slots_.assign(slots, kFree);
        leaves_.reserve(std::min({points, slots / 2, kMaxSamples + 1}));
    }

    /// The leaf of a key, until the next call; a new one is anchored at (x, y, z).
    Leaf<Sums>& find(std::uint64_t key, float x, float y, float z) {
        const std::size_t mask = slots_.size() - 1;
        for (std::size_t slot = hash(key) & mask;; slot = (slot + 1) & mask) {
            if (slots_[slot] == kFree) {
                if (2 * (leaves_.size() + 1) > slots_.size()) {
                    grow();
                    return find(key, x, y, z);
                }
                slots_[slot] = static_cast<std::uint32_t>(leaves_.size());
                leaves_.push_back({key, {x, y, z}, {}});
            }
            Leaf<Sums>& leaf = leaves_[slots_[slot]];
            if (leaf.key == key) return leaf;
        }
    }

    const std::vector<Leaf<Sums>>& leaves() const { return leaves_; }

 private:
    static constexpr std::uint32_t kFree = 0xFFFFFFFFU;

    static std::size_t hash(std::uint64_t key) {
        key *= 0x9E3779B97F4A7C15ULL;
        return static_cast<std::size_t>(key ^ (key >> 32U));
    }

    void grow() {
        slots_.assign(slots_.size() * 4, kFree);
        const std::size_t mask = slots_.size() - 1;
        for (std::uint32_t i = 0; i < leaves_.size(); ++i) {
            std::size_t slot = hash(leaves_[i].key) & mask;
            while (slots_[slot] != kFree) slot = (slot + 1) & mask;
            slots_[slot] = i;
        }
    }

    std::vector<std::uint32_t> slots_;
    std::vector<Leaf<Sums>> leaves_;
};

/// Keys of the points from `begin` on, at most kPointsPerChunk. Returns how many.
constexpr std::size_t kPointsPerChunk = 64;
inline std::size_t keysFrom(const Scan& scan, std::size_t begin, const LeafKeys& keys,
                            std::uint64_t* out) {
    const std::size_t count = std::min(kPointsPerChunk, scan.size() - begin);
    for (std::size_t k = 0; k < count; k += 4) {
        const Leaves4 leaves = keys.leavesOf(loadUpTo4(&scan.x[begin + k], count - k),
                                             loadUpTo4(&scan.y[begin + k], count - k),
                                             loadUpTo4(&scan.z[begin + k], count - k));
        for (unsigned lane = 0; lane < 4; ++lane)
            out[k + lane] =
                leaves.isInRange[lane] == 0 ? LeafKeys::kDropped : leaves.key(lane);
    }
    return count;
}

/// Counts a point that is not in range.
inline void countDropped(const Eigen::Vector3f& point, float maxRange2,
                         FilterCounts& counted) {
    if (!point.allFinite())
        ++counted.notFinite;
    else if (point.squaredNorm() > maxRange2)
        ++counted.cut;
    else
        ++counted.tooNear;
}

/// Adds the points that are in range to the sums of their leaves, unless they fill more
/// than there may be samples. Returns whether it did.
/// @param add add(sums, i, dx, dy, dz) adds point i, so far from the anchor [m]
template <typename Sums, typename Add>
bool addToLeaves(const Scan& scan, const LeafKeys& keysOf, VoxelTable<Sums>& table,
                 Add&& add) {
    // Neighbouring points mostly share a leaf: its sums are held until another one's turn.
    std::uint64_t keys[kPointsPerChunk], current = LeafKeys::kDropped;
    Leaf<Sums>* leaf = nullptr;
    Sums sums{};
    std::array<float, 3> anchor{};
    for (std::size_t begin = 0; begin < scan.size(); begin += kPointsPerChunk) {
        const std::size_t count = keysFrom(scan, begin, keysOf, keys);
        for (std::size_t k = 0; k < count; ++k) {
            const std::size_t i = begin + k;
            const float x = scan.x[i], y = scan.y[i], z = scan.z[i];
            if (keys[k] == LeafKeys::kDropped) continue;
            if (keys[k] != current) {
                if (leaf != nullptr) std::swap(sums, leaf->sums);
                current = keys[k];
                leaf = &table.find(current, x, y, z);
                std::swap(sums, leaf->sums);
                anchor = leaf->anchor;
            }
            add(sums, i, double(x) - anchor[0], double(y) - anchor[1],
                double(z) - anchor[2]);
        }
        if (table.leaves().size() > kMaxSamples) return false;
    }
    if (leaf != nullptr) std::swap(sums, leaf->sums);
    return true;
}

/// The leaves of the points that are in range, at most kMaxSamples, each with its sums.
template <typename Sums, typename Add>
VoxelTable<Sums> leavesOf(const Scan& scan, FilterParams params, Add&& add) {
    for (;; params = doubled(params)) {
        VoxelTable<Sums> table(scan.size());
        if (addToLeaves(scan, LeafKeys(params), table, add)) return table;
    }
}

}  // namespace hgmm
