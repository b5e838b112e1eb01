#pragma once
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>

#include "base/hash_table.h"
#include "base/power_of_two.h"

namespace hgmm {

/// The cells that a box touches, on the lattice of cubes just above its own largest half
/// extent.
struct BoxCells {
    static constexpr int kMinOctave = -10, kMaxOctave = 30;

    struct Box {
        std::array<float, 3> centre{};      ///< [m]
        std::array<float, 3> halfExtent{};  ///< [m], in [0, 2^kMaxOctave]
    };
    using Cell = std::array<std::int32_t, 3>;

    int octave = 0;  ///< cells have edges of 2^octave m
    Cell low{}, high{};

    bool operator==(const BoxCells& o) const {
        return octave == o.octave && low == o.low && high == o.high;
    }
    static constexpr std::int32_t kLimit = 1 << 30;
    /// All that is beyond the limit shares the cells there; NaN, which nothing is at, any.
    static std::int32_t cellOf(float v, float perCell) {
        const float cell = v * perCell;
        if (!(cell > float(-kLimit) && cell < float(kLimit)))
            return cell < 0 ? -kLimit : kLimit;
        return floorToInt(cell);
    }
    static Cell cellOf(const std::array<float, 3>& point, int octave) {
        const float perCell = floatPowerOfTwo(-octave);
        return {cellOf(point[0], perCell), cellOf(point[1], perCell),
                cellOf(point[2], perCell)};
    }
    /// @param finer octaves below those of boxes
    /// @param leastOctave boxes so small share cells of this size, in [-10, 30]
    static BoxCells of(const Box& box, int finer = 0, int leastOctave = kMinOctave) {
        const float largest = std::max({box.halfExtent[0], box.halfExtent[1],
                                        box.halfExtent[2], floatPowerOfTwo(kMinOctave)});
        BoxCells cells;
        cells.octave = std::clamp(static_cast<int>(std::ceil(std::log2(largest))) - finer,
                                  leastOctave, kMaxOctave);
        const float perCell = floatPowerOfTwo(-cells.octave);
        for (int d = 0; d < 3; ++d) {
            cells.low[d] = cellOf(box.centre[d] - box.halfExtent[d], perCell);
            cells.high[d] = cellOf(box.centre[d] + box.halfExtent[d], perCell);
        }
        return cells;
    }
    /// Whether one of them holds a point between two corners.
    bool meet(const float* from, const float* to) const {
        const Cell first = cellOf({from[0], from[1], from[2]}, octave);
        const Cell last = cellOf({to[0], to[1], to[2]}, octave);
        bool meets = true;
        for (int d = 0; d < 3; ++d)
            meets = meets && first[d] <= high[d] && low[d] <= last[d];
        return meets;
    }
};

/// Cells of all octaves as numbers: 7 bits for the octave, 19 for each axis. Cells that are
/// 2^19 apart share one.
struct PackedCellKeys {
    static std::uint64_t of(int octave, const BoxCells::Cell& cell) {
        constexpr std::uint64_t mask = (1U << 19U) - 1U;
        std::uint64_t key = std::uint64_t(octave - BoxCells::kMinOctave);
        for (const std::int32_t c : cell) key = key << 19U | (std::uint64_t(c) & mask);
        return key;
    }
    static std::uint64_t unused() { return ~std::uint64_t{0}; }
    static std::uint64_t hash(std::uint64_t key) {
        key *= 0x9E3779B97F4A7C15ULL;
        return key ^ key >> 32U;
    }
};

/// Values by such a number.
template <typename Value>
using PackedCellTable = HashTable<std::uint64_t, Value, PackedCellKeys>;

/// Which octaves any box has.
class OctavesInUse {
 public:
    void add(int octave) { count(octave, 1); }
    void remove(int octave) { count(octave, -1); }
    /// Rising.
    const std::int8_t* begin() const { return used_.data(); }
    const std::int8_t* end() const { return used_.data() + usedCount_; }

 private:
    static constexpr int kOctaves = BoxCells::kMaxOctave - BoxCells::kMinOctave + 1;

    void count(int octave, int boxes) {
        std::uint32_t& here = boxes_[octave - BoxCells::kMinOctave];
        const bool wasUsed = here > 0;
        here += static_cast<std::uint32_t>(boxes);
        if (wasUsed == (here > 0)) return;
        usedCount_ = 0;
        for (int o = 0; o < kOctaves; ++o)
            if (boxes_[o] > 0)
                used_[usedCount_++] = static_cast<std::int8_t>(o + BoxCells::kMinOctave);
    }

    std::array<std::uint32_t, kOctaves> boxes_{};
    std::array<std::int8_t, kOctaves> used_{};
    int usedCount_ = 0;
};

/// Calls visit(cell) for each cell of an octave that the ray from `start` along the unit
/// vector `direction` comes to within `length` [m]. Returns false, having visited none, if
/// there are more than maxCells of them, or they are too far for numbers of cells.
template <typename Visitor>
bool walkRay(const float* start, const float* direction, float length, int octave,
             float maxCells, Visitor&& visit) {
    constexpr float kFarthest = 1 << 29;
    const float perCell = floatPowerOfTwo(-octave);
    const float farthest =
        std::max({std::abs(start[0]), std::abs(start[1]), std::abs(start[2])}) + length;
    if (!(farthest * perCell < kFarthest) || length * perCell > maxCells) return false;
    // Steps from one cell boundary to the next, along whichever axis comes first.
    BoxCells::Cell cell = BoxCells::cellOf({start[0], start[1], start[2]}, octave);
    std::array<double, 3> toBoundary{}, betweenBoundaries{};
    for (int d = 0; d < 3; ++d) {
        const double speed = std::abs(double(direction[d])) * perCell;
        betweenBoundaries[d] = speed > 1e-12 ? 1.0 / speed : 1e30;
        const double inside = double(start[d]) * perCell - cell[d];
        toBoundary[d] = betweenBoundaries[d] * (direction[d] > 0 ? 1.0 - inside : inside);
    }
    for (double travelled = 0; travelled <= length;) {
        visit(cell);
        int axis = toBoundary[0] < toBoundary[1] ? 0 : 1;
        if (toBoundary[2] < toBoundary[axis]) axis = 2;
        travelled = toBoundary[axis];
        toBoundary[axis] += betweenBoundaries[axis];
        cell[axis] += direction[axis] > 0 ? 1 : -1;
    }
    return true;
}

}  // namespace hgmm
