#pragma once
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <utility>
#include <vector>

#include "base/power_of_two.h"

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
    static constexpr int kMinOctave = -10, kMaxOctave = 20;

    struct Box {
        std::array<float, 3> centre{};      ///< [m]
        std::array<float, 3> halfExtent{};  ///< [m], >= 0
    };

    /// How large cells are.
    struct Cells {
        int finer = 0;  ///< octaves below those of boxes [octave]
        /// Boxes so small share cells of 2^leastOctave metres, in [-10, 20].
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

    /// Calls visit(i) for each box in whose cells the ray from `start` along the unit
    /// vector `direction` comes within `length` [m], possibly several times.
    template <typename Visitor>
    void visitAlongRay(const float* start, const float* direction, float length,
                       Visitor&& visit) const;

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
    /// `v` in cells of 1 / perCell metres. Beyond the limit (and for NaN) any cell will do:
    /// nothing is indexed there.
    static std::int32_t cellOf(float v, float perCell) {
        constexpr float limit = 1 << 30;
        const float cell = v * perCell;
        if (!(cell > -limit && cell < limit)) return 1 << 30;
        return floorToInt(cell);
    }
    static float perCell(int octave) { return floatPowerOfTwo(-octave); }

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
void BoxIndex::visitAlongRay(const float* start, const float* direction, float length,
                             Visitor&& visit) const {
    for (int o = 0; o < usedOctaveCount_; ++o) {
        const int octave = usedOctaves_[o];
        const float scale = perCell(octave);
        // Steps from one cell boundary to the next, along whichever axis comes first.
        std::array<std::int32_t, 3> cell{};
        std::array<float, 3> toBoundary{}, betweenBoundaries{};
        for (int d = 0; d < 3; ++d) {
            cell[d] = cellOf(start[d], scale);
            const float speed = std::abs(direction[d]) * scale;
            betweenBoundaries[d] = speed > 1e-12F ? 1.F / speed : 1e30F;
            const float inside = start[d] * scale - static_cast<float>(cell[d]);
            toBoundary[d] =
                betweenBoundaries[d] * (direction[d] > 0 ? 1.F - inside : inside);
        }
        for (float travelled = 0; travelled <= length;) {
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
