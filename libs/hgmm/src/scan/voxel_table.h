#pragma once
#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cstdint>
#include <cstring>
#include <utility>
#include <vector>

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

/// The leaves of points: an octave by the range, and indices in its lattice.
class LeafKeys {
 public:
    /// No leaf has this key: that of a point out of range.
    static constexpr std::uint64_t kDropped = ~std::uint64_t{0};

    explicit LeafKeys(const FilterParams& params)
        : resolution4_(fourthPower(params.resolution_m)),
          minLeaf4_(fourthPower(params.minLeaf_m)),
          minRange2_(static_cast<float>(params.minRange_m * params.minRange_m)),
          maxRange2_(static_cast<float>(params.maxRange_m * params.maxRange_m)) {}

    float maxRange2() const { return maxRange2_; }  ///< [m^2]

    /// Of a point at any range.
    std::uint64_t atAnyRange(float x, float y, float z) const {
        const Float4 ones = 1.F + Float4{};
        const Float4 range2 = (x * x + y * y + z * z) * ones;
        return packed(octaveAt(range2), x * ones, y * ones, z * ones, 0);
    }

    /// Of four points.
    void of(Float4 x, Float4 y, Float4 z, std::uint64_t* keys) const {
        const Float4 range2 = x * x + y * y + z * z;
        const Int4 isInRange =
            (range2 >= minRange2_) & (range2 <= maxRange2_) & (range2 != 0.F);
        const Int4 octave = octaveAt(range2);
        for (int k = 0; k < 4; ++k)
            keys[k] = isInRange[k] == 0 ? kDropped : packed(octave, x, y, z, k);
    }

 private:
    // 19 bits an axis hold any leaf index, at the smallest leaves and 100 km.
    static constexpr unsigned kIndexBits = 19;
    static constexpr std::int32_t kMask = (1 << kIndexBits) - 1;
    /// Of the edge of leaves at a squared range.
    Int4 octaveAt(Float4 range2) const {
        // An edge of c sqrt(r) has the octave of its fourth power c^4 r^2, divided by four.
        const Float4 edge4 = resolution4_ * range2;
        const Int4 isLarger = edge4 > minLeaf4_;
        const Float4 least = minLeaf4_ + Float4{};
        const Int4 bits = (isLarger & (Int4)edge4) | (~isLarger & (Int4)least);
        return ((bits >> 23) - 127) >> 2;
    }
    /// The key of point k of four.
    static std::uint64_t packed(Int4 octave, Float4 x, Float4 y, Float4 z, int k) {
        const auto perLeaf = (Float4)((127 - octave) << 23);
        const Int4 ix = floorToInt(x * perLeaf) & kMask,
                   iy = floorToInt(y * perLeaf) & kMask,
                   iz = floorToInt(z * perLeaf) & kMask;
        return static_cast<std::uint64_t>(octave[k] + 32) << (3 * kIndexBits) |
               std::uint64_t(ix[k]) << (2 * kIndexBits) |
               std::uint64_t(iy[k]) << kIndexBits | std::uint64_t(iz[k]);
    }
    static float fourthPower(double v) { return static_cast<float>(v * v * v * v); }

    float resolution4_, minLeaf4_;  // [m^4]
    float minRange2_, maxRange2_;   // [m^2]
};

/// Keys of the points from `begin` on, at most kPointsPerChunk. Returns how many.
constexpr std::size_t kPointsPerChunk = 64;
inline std::size_t keysFrom(const Scan& scan, std::size_t begin, const LeafKeys& keys,
                            std::uint64_t* out) {
    const std::size_t count = std::min(kPointsPerChunk, scan.size() - begin);
    for (std::size_t k = 0; k < count; k += 4) {
        Float4 p[3] = {};
        const std::size_t bytes = std::min<std::size_t>(4, count - k) * sizeof(float);
        std::memcpy(&p[0], &scan.x[begin + k], bytes);
        std::memcpy(&p[1], &scan.y[begin + k], bytes);
        std::memcpy(&p[2], &scan.z[begin + k], bytes);
        keys.of(p[0], p[1], p[2], out + k);
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

/// The leaves of the points that are in range, each with its sums.
/// @param add add(sums, i, dx, dy, dz) adds point i, so far from the anchor [m]
template <typename Sums, typename Add>
VoxelTable<Sums> sumLeaves(const Scan& scan, const FilterParams& params,
                           FilterCounts& counted, Add&& add) {
    const LeafKeys keysOf(params);
    VoxelTable<Sums> table(scan.size());
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
            if (keys[k] == LeafKeys::kDropped) {
                countDropped({x, y, z}, keysOf.maxRange2(), counted);
                continue;
            }
            if (keys[k] != current) {
                if (leaf != nullptr) std::swap(sums, leaf->sums);
                current = keys[k];
                leaf = &table.find(current, x, y, z);
                std::swap(sums, leaf->sums);
                anchor = leaf->anchor;
            }
            add(sums, i, double(x) - anchor[0], double(y) - anchor[1],
                double(z) - anchor[2]);
            ++counted.used;
        }
    }
    if (leaf != nullptr) std::swap(sums, leaf->sums);
    return table;
}

}  // namespace hgmm
