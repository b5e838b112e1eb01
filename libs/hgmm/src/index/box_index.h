#pragma once
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <utility>
#include <vector>

#include "base/power_of_two.h"
#include "index/cell_order.h"

namespace hgmm {

/// Finds the boxes that may hold a point at a cost that does not depend on how many there
/// are.
///
/// A hash grid with one level per octave of size: a box is entered in every cell, of a size
/// just above its own largest half extent, that it touches; a query looks up one cell per
/// level in use. Cells lie in one open-addressing table whose members are stored
/// contiguously.
class BoxIndex {
 public:
    static constexpr int kMinOctave = -10, kMaxOctave = 30;

    struct Box {
        std::array<float, 3> centre{};      ///< [m]
        std::array<float, 3> halfExtent{};  ///< [m], >= 0
    };

    /// How large cells are.
    struct Cells {
        int finer = 0;  ///< octaves below those of boxes [octave]
        /// Boxes so small share cells of 2^leastOctave metres, in [-10, 30].
        int leastOctave = kMinOctave;
    };

    BoxIndex() = default;
    explicit BoxIndex(const Cells& cells) : cells_(cells) {}

    /// Enters or re-enters box i, which must be < size() or the next one.
    void update(std::uint32_t i, const Box& box);
    /// The same for a body inside its box: enters it in the cells that it touches.
    /// @param touches touches(centre, halfEdge) tells it of a cube, const float* and float
    /// [m]; it may err for cubes that are only nearly touched
    /// @param touched the same test of the body that box i held before; not called for a
    /// new box
    template <typename Touches, typename Touched>
    void update(std::uint32_t i, const Box& box, Touches&& touches, Touched&& touched);
    /// Drops boxes n, n + 1, ...
    void truncate(std::size_t n);
    void clear();
    /// Makes room for n boxes in all.
    void reserve(std::size_t n);
    std::size_t size() const { return placements_.size(); }

    /// Calls visit(i) for each box in whose cells (x, y, z) lies, each once, smaller cells
    /// first and rising within a cell: an order that depends on the boxes alone.
    template <typename Visitor>
    void visitCandidates(float x, float y, float z, Visitor&& visit) const;

    /// Whether visitCandidates may visit a box, once it is entered, at a point between two
    /// corners.
    bool reaches(const Box& box, const float* low, const float* high) const;

    /// Calls visit(i) for each box in whose cells the ray from `start` along the unit
    /// vector `direction` comes within `length` [m], possibly several times.
    template <typename Visitor>
    void visitAlongRay(const float* start, const float* direction, float length,
                       Visitor&& visit) const;

    /// The same for points that follow each other in few cells: calls visit(i, first, last)
    /// for each box in whose cells the points first to last - 1 lie. A point's boxes
    /// come in the order that it gets them in alone.
    template <typename Visitor>
    void visitCandidates(const CellOrder& points, std::size_t begin, std::size_t end,
                         Visitor&& visit) const;
    /// Octave of the smallest cells in use; 0 if there are none.
    int smallestOctave() const { return usedOctaveCount_ > 0 ? usedOctaves_[0] : 0; }

    /// Heap held [bytes].
    std::size_t liveBytes() const;

 private:
    struct Placement {
        std::int8_t octave = 0;
        std::array<std::int32_t, 3> low{}, high{};
        bool operator==(const Placement& o) const {
            return octave == o.octave && low == o.low && high == o.high;
        }
    };
    /// A cell's members are pool_[begin .. begin + count); room for 1 << capacityLog2. A
    /// single one, as most cells have, is `begin` itself: capacityLog2 is 0.
    struct Slot {
        std::uint64_t key = kUnused;
        std::uint32_t begin = 0;
        std::uint32_t count : 27;
        std::uint32_t capacityLog2 : 5;
        Slot() : count(0), capacityLog2(0) {}
        bool used() const { return key != kUnused; }
    };

    static constexpr std::uint64_t kUnused = ~std::uint64_t{0};  ///< no cell has this key
    static constexpr int kOctaves = kMaxOctave - kMinOctave + 1;

    static std::uint64_t keyOf(int octave, std::int32_t x, std::int32_t y, std::int32_t z) {
        constexpr std::uint64_t mask = (1U << 19U) - 1U;
        return std::uint64_t(octave - kMinOctave) << 57U |
               (std::uint64_t(x) & mask) << 38U | (std::uint64_t(y) & mask) << 19U |
               (std::uint64_t(z) & mask);
    }
    static std::size_t hash(std::uint64_t key) {
        key *= 0x9E3779B97F4A7C15ULL;
        return static_cast<std::size_t>(key ^ key >> 32U);
    }
    /// `v` in cells of 1 / perCell metres. All that is beyond the limit shares the cells
    /// there; NaN, which nothing is indexed at, any.
    static std::int32_t cellOf(float v, float perCell) {
        constexpr std::int32_t kLimit = 1 << 30;
        const float cell = v * perCell;
        if (!(cell > float(-kLimit) && cell < float(kLimit)))
            return cell < 0 ? -kLimit : kLimit;
        return floorToInt(cell);
    }
    static float perCell(int octave) { return floatPowerOfTwo(-octave); }

    /// Whether a ray passes so many cells, or such far ones, that looking at all boxes is
    /// better.
    bool isLongFor(const float* start, float length, float perCell) const {
        constexpr float kFarthest = 1 << 29;
        const float farthest =
            std::max({std::abs(start[0]), std::abs(start[1]), std::abs(start[2])}) + length;
        return !(farthest * perCell < kFarthest) ||
               length * perCell > 1000.F + 4.F * static_cast<float>(size());
    }
    /// What a test of bodies says of a cell.
    template <typename Test>
    static bool holds(Test&& test, int octave, std::int32_t x, std::int32_t y,
                      std::int32_t z) {
        const float edge = floatPowerOfTwo(octave);
        const float centre[3] = {(float(x) + 0.5F) * edge, (float(y) + 0.5F) * edge,
                                 (float(z) + 0.5F) * edge};
        return test(centre, 0.5F * edge);
    }
    Placement placementOf(const Box& box) const;
    /// Notes where box i is from now on; its cells are left as they are.
    void place(std::uint32_t i, const Placement& placement);
    template <typename Visitor>
    static void forEachCell(const Placement& p, Visitor&& visit);
    /// Counts a box in or out.
    void count(int octave, int boxes);
    const std::uint32_t* membersOf(const Slot& slot) const {
        return slot.capacityLog2 == 0 ? &slot.begin : pool_.data() + slot.begin;
    }
    std::uint32_t* membersOf(Slot& slot) {
        return slot.capacityLog2 == 0 ? &slot.begin : pool_.data() + slot.begin;
    }
    const Slot* find(std::uint64_t key) const;
    Slot& findOrAdd(std::uint64_t key);
    void growTable(std::size_t slots);
    std::uint32_t allocate(unsigned capacityLog2);
    void add(std::uint64_t key, std::uint32_t i);
    void remove(std::uint64_t key, std::uint32_t i);

    Cells cells_;
    std::vector<Placement> placements_;
    std::vector<Slot> slots_;
    std::size_t usedSlots_ = 0;
    std::vector<std::uint32_t> pool_;
    std::array<std::vector<std::uint32_t>, 32> free_;  ///< begins of unused runs, by size
    std::array<std::uint32_t, kOctaves> boxesInOctave_{};
    std::array<std::int8_t, kOctaves>
        usedOctaves_{};  ///< the first usedOctaveCount_, rising
    int usedOctaveCount_ = 0;
};

inline const BoxIndex::Slot* BoxIndex::find(std::uint64_t key) const {
    const std::size_t mask = slots_.size() - 1;
    for (std::size_t s = hash(key) & mask;; s = (s + 1) & mask) {
        if (!slots_[s].used()) return nullptr;
        if (slots_[s].key == key) return &slots_[s];
    }
}

template <typename Visitor>
void BoxIndex::forEachCell(const Placement& p, Visitor&& visit) {
    for (std::int32_t x = p.low[0]; x <= p.high[0]; ++x)
        for (std::int32_t y = p.low[1]; y <= p.high[1]; ++y)
            for (std::int32_t z = p.low[2]; z <= p.high[2]; ++z) visit(x, y, z);
}

template <typename Touches, typename Touched>
void BoxIndex::update(std::uint32_t i, const Box& box, Touches&& touches,
                      Touched&& touched) {
    const Placement p = placementOf(box);
    const bool isNew = i >= size(), stays = !isNew && placements_[i] == p;
    if (!isNew && !stays) {
        const Placement& old = placements_[i];
        forEachCell(old, [&](auto... cell) {
            if (holds(touched, old.octave, cell...)) remove(keyOf(old.octave, cell...), i);
        });
    }
    place(i, p);
    // Most cells of a body that moved a little are those that it touched before.
    forEachCell(p, [&](auto... cell) {
        const bool was = stays && holds(touched, p.octave, cell...);
        const bool is = holds(touches, p.octave, cell...);
        if (was && !is) remove(keyOf(p.octave, cell...), i);
        if (is && !was) add(keyOf(p.octave, cell...), i);
    });
}

template <typename Visitor>
void BoxIndex::visitCandidates(float x, float y, float z, Visitor&& visit) const {
    for (int o = 0; o < usedOctaveCount_; ++o) {
        const int octave = usedOctaves_[o];
        const float scale = perCell(octave);
        const Slot* slot =
            find(keyOf(octave, cellOf(x, scale), cellOf(y, scale), cellOf(z, scale)));
        if (slot == nullptr) continue;
        const std::uint32_t* member = membersOf(*slot);
        for (std::uint32_t k = 0; k < slot->count; ++k) visit(member[k]);
    }
}

template <typename Visitor>
void BoxIndex::visitCandidates(const CellOrder& points, std::size_t begin, std::size_t end,
                               Visitor&& visit) const {
    for (int o = 0; o < usedOctaveCount_; ++o) {
        const int octave = usedOctaves_[o];
        const float scale = perCell(octave);
        const auto keyAt = [&](std::size_t k) {
            return keyOf(octave, cellOf(points.x[k], scale), cellOf(points.y[k], scale),
                         cellOf(points.z[k], scale));
        };
        std::uint64_t key = begin < end ? keyAt(begin) : kUnused;
        for (std::size_t first = begin, last = begin; first < end; first = last) {
            const std::uint64_t cell = key;
            for (++last; last < end && (key = keyAt(last)) == cell;) ++last;
            const Slot* slot = find(cell);
            if (slot == nullptr) continue;
            const std::uint32_t* member = membersOf(*slot);
            for (std::uint32_t k = 0; k < slot->count; ++k) visit(member[k], first, last);
        }
    }
}

template <typename Visitor>
void BoxIndex::visitAlongRay(const float* start, const float* direction, float length,
                             Visitor&& visit) const {
    for (int o = 0; o < usedOctaveCount_; ++o) {
        const int octave = usedOctaves_[o];
        const float scale = perCell(octave);
        if (isLongFor(start, length, scale)) {
            for (std::uint32_t i = 0; i < size(); ++i)
                if (placements_[i].octave == octave) visit(i);
            continue;
        }
        // Steps from one cell boundary to the next, along whichever axis comes first.
        std::array<std::int32_t, 3> cell{};
        std::array<double, 3> toBoundary{}, betweenBoundaries{};
        for (int d = 0; d < 3; ++d) {
            cell[d] = cellOf(start[d], scale);
            const double speed = std::abs(double(direction[d])) * scale;
            betweenBoundaries[d] = speed > 1e-12 ? 1.0 / speed : 1e30;
            const double inside = double(start[d]) * scale - cell[d];
            toBoundary[d] =
                betweenBoundaries[d] * (direction[d] > 0 ? 1.0 - inside : inside);
        }
        for (double travelled = 0; travelled <= length;) {
            const Slot* slot = find(keyOf(octave, cell[0], cell[1], cell[2]));
            for (std::uint32_t k = 0; slot != nullptr && k < slot->count; ++k)
                visit(membersOf(*slot)[k]);
            int axis = toBoundary[0] < toBoundary[1] ? 0 : 1;
            if (toBoundary[2] < toBoundary[axis]) axis = 2;
            travelled = toBoundary[axis];
            toBoundary[axis] += betweenBoundaries[axis];
            cell[axis] += direction[axis] > 0 ? 1 : -1;
        }
    }
}

}  // namespace hgmm
