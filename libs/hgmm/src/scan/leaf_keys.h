#pragma once
#include <algorithm>
#include <cstddef>
#include <cstdint>

#include "base/simd.h"
#include "hgmm/params.h"
#include "hgmm/scan.h"

namespace hgmm {

/// Leaves of four points: an octave by the range, and indices in its lattice.
struct Leaves4 {
    Int4 isInRange;  ///< -1 or 0; where not, the leaf says nothing
    Int4 octave, x, y, z;

    /// A key of the leaf of point k.
    std::uint64_t key(unsigned k) const {
        // 19 bits an axis hold any leaf index, at the smallest leaves and 100 km.
        constexpr unsigned kBits = 19;
        constexpr std::int32_t kMask = (1 << kBits) - 1;
        return std::uint64_t(octave[k] + 32) << (3 * kBits) |
               std::uint64_t(x[k] & kMask) << (2 * kBits) |
               std::uint64_t(y[k] & kMask) << kBits | std::uint64_t(z[k] & kMask);
    }
    /// Which of the points lie in a leaf, of which all lanes tell.
    Int4 areIn(const Leaves4& leaf) const {
        return (x == leaf.x) & (y == leaf.y) & (z == leaf.z) & (octave == leaf.octave);
    }
    /// The leaf of point k in all lanes.
    Leaves4 lane(unsigned k) const {
        const auto all = [k](Int4 v) { return v[k] - Int4{}; };
        return {all(isInRange), all(octave), all(x), all(y), all(z)};
    }
};

/// The same filter with leaves of twice the edge.
inline FilterParams doubled(FilterParams params) {
    params.resolution_m *= 2;
    params.minLeaf_m *= 2;
    return params;
}

/// The leaves of points.
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
        return leavesOf(x - Float4{}, y - Float4{}, z - Float4{}).key(0);
    }

    Leaves4 leavesOf(Float4 x, Float4 y, Float4 z) const {
        const Float4 range2 = x * x + y * y + z * z;
        const Int4 octave = octaveAt(range2);
        const auto perLeaf = (Float4)((127 - octave) << 23);
        return {(range2 >= minRange2_) & (range2 <= maxRange2_) & (range2 != 0.F), octave,
                floorToInt(x * perLeaf), floorToInt(y * perLeaf), floorToInt(z * perLeaf)};
    }

 private:
    /// Of the edge of leaves at a squared range.
    Int4 octaveAt(Float4 range2) const {
        // An edge of c sqrt(r) has the octave of its fourth power c^4 r^2, divided by four.
        const Float4 edge4 = resolution4_ * range2;
        const Int4 isLarger = edge4 > minLeaf4_;
        const Float4 least = minLeaf4_ + Float4{};
        const Int4 bits = (isLarger & (Int4)edge4) | (~isLarger & (Int4)least);
        return ((bits >> 23) - 127) >> 2;
    }
    static float fourthPower(double v) { return static_cast<float>(v * v * v * v); }

    float resolution4_, minLeaf4_;  // [m^4]
    float minRange2_, maxRange2_;   // [m^2]
};

}  // namespace hgmm
