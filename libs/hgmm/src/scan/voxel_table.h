#pragma once
#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cstdint>
#include <vector>

#include "base/power_of_two.h"
#include "base/simd.h"
#include "hgmm/scan.h"

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
        leaves_.reserve(std::min(points, slots / 2));
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

inline std::uint64_t leafKey(int octave, Float4 point) {
    // 19 bits an axis hold any leaf index, at the smallest leaves and 100 km.
    constexpr unsigned kIndexBits = 19;
    constexpr std::int32_t mask = (1 << kIndexBits) - 1;
    const Int4 index = floorToInt(point * floatPowerOfTwo(-octave)) & mask;
    return static_cast<std::uint64_t>(octave + 32) << (3 * kIndexBits) |
           std::uint64_t(index[0]) << (2 * kIndexBits) |
           std::uint64_t(index[1]) << kIndexBits | std::uint64_t(index[2]);
}

/// The octave of a leaf's edge by the squared range of its points.
class LeafOctave {
 public:
    explicit LeafOctave(const FilterParams& params)
        : resolution4_(fourthPower(params.resolution_m)),
          minLeaf4_(fourthPower(params.minLeaf_m)) {}

    /// @param range2 [m^2]
    int operator()(float range2) const {
        // An edge of c sqrt(r) has the octave of its fourth power c^4 r^2, divided by four.
        return octaveOf(std::max(minLeaf4_, resolution4_ * range2)) >> 2;
    }

 private:
    static float fourthPower(double v) { return static_cast<float>(v * v * v * v); }

    float resolution4_, minLeaf4_;  // [m^4]
};

/// Counts a point that is not in range.
inline void countDropped(const Eigen::Vector3f& point, float range2, float maxRange2,
                         FilterCounts& counted) {
    if (!point.allFinite())
        ++counted.notFinite;
    else if (range2 > maxRange2)
        ++counted.cut;
    else
        ++counted.tooNear;
}

/// The leaves of the points that are in range, each with its sums.
/// @param add add(sums, i, dx, dy, dz) adds point i, so far from the anchor [m]
template <typename Sums, typename Add>
VoxelTable<Sums> sumLeaves(const Scan& scan, const FilterParams& params,
                           FilterCounts& counted, Add&& add) {
    const LeafOctave octaveAt(params);
    const auto minRange2 = static_cast<float>(params.minRange_m * params.minRange_m);
    const auto maxRange2 = static_cast<float>(params.maxRange_m * params.maxRange_m);
    VoxelTable<Sums> table(scan.size());
    // Neighbouring points mostly share a leaf.
    std::uint64_t current = ~std::uint64_t{0};
    Leaf<Sums>* leaf = nullptr;
    for (std::size_t i = 0; i < scan.size(); ++i) {
        const float x = scan.x[i], y = scan.y[i], z = scan.z[i];
        const float range2 = x * x + y * y + z * z;
        if (!(range2 >= minRange2 && range2 <= maxRange2) || range2 == 0.F) {
            countDropped({x, y, z}, range2, maxRange2, counted);
            continue;
        }
        const std::uint64_t key = leafKey(octaveAt(range2), Float4{x, y, z, 0.F});
        if (key != current) {
            current = key;
            leaf = &table.find(key, x, y, z);
        }
        add(leaf->sums, i, double(x) - leaf->anchor[0], double(y) - leaf->anchor[1],
            double(z) - leaf->anchor[2]);
        ++counted.used;
    }
    return table;
}

}  // namespace hgmm
