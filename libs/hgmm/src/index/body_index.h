#pragma once
#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "index/box_cells.h"

namespace hgmm {

/// Finds the bodies that may hold a point: those that touch its cell, of cells a few
/// octaves below their own size, so that next to nothing is passed over. Memory follows the
/// cells that are touched.
///
/// Cells lie in one open-addressing table whose members are stored contiguously.
class BodyIndex {
 public:
    using Box = BoxCells::Box;

    /// How large cells are.
    struct Cells {
        int finer = 0;  ///< octaves below those of boxes [octave]
        /// Boxes so small share cells of 2^leastOctave metres, in [-10, 30].
        int leastOctave = BoxCells::kMinOctave;
    };

    explicit BodyIndex(const Cells& cells) : cells_(cells) {}

    /// Enters or re-enters body i, which must be < size() or the next one, in the cells
    /// within its box that it touches.
    /// @param touches touches(centre, halfEdge) tells it of a cube, const float* and float
    /// [m]; it may err for cubes that are only nearly touched
    /// @param touched the same test of the body that was there before; not called for a new
    /// one
    template <typename Touches, typename Touched>
    void update(std::uint32_t i, const Box& box, Touches&& touches, Touched&& touched);
    /// Drops bodies n, n + 1, ...
    void truncate(std::size_t n);
    /// Makes room for n bodies in all.
    void reserve(std::size_t n);
    std::size_t size() const { return placements_.size(); }

    /// Calls visit(i) for each body that touches the cell of (x, y, z), each once, smaller
    /// cells first and rising within a cell: an order that depends on the bodies alone.
    template <typename Visitor>
    void visitCandidates(float x, float y, float z, Visitor&& visit) const;

    /// Heap held [bytes].
    std::size_t liveBytes() const;

 private:
    static constexpr int kMinOctave = BoxCells::kMinOctave,
                         kMaxOctave = BoxCells::kMaxOctave;
    using Placement = BoxCells;
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
    /// What a test of bodies says of a cell.
    template <typename Test>
    static bool holds(Test&& test, int octave, std::int32_t x, std::int32_t y,
                      std::int32_t z) {
        const float edge = floatPowerOfTwo(octave);
        const float centre[3] = {(float(x) + 0.5F) * edge, (float(y) + 0.5F) * edge,
                                 (float(z) + 0.5F) * edge};
        return test(centre, 0.5F * edge);
    }
    Placement placementOf(const Box& box) const {
        return BoxCells::of(box, cells_.finer, cells_.leastOctave);
    }
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

inline const BodyIndex::Slot* BodyIndex::find(std::uint64_t key) const {
    const std::size_t mask = slots_.size() - 1;
    for (std::size_t s = hash(key) & mask;; s = (s + 1) & mask) {
        if (!slots_[s].used()) return nullptr;
        if (slots_[s].key == key) return &slots_[s];
    }
}

template <typename Visitor>
void BodyIndex::forEachCell(const Placement& p, Visitor&& visit) {
    for (std::int32_t x = p.low[0]; x <= p.high[0]; ++x)
        for (std::int32_t y = p.low[1]; y <= p.high[1]; ++y)
            for (std::int32_t z = p.low[2]; z <= p.high[2]; ++z) visit(x, y, z);
}

template <typename Touches, typename Touched>
void BodyIndex::update(std::uint32_t i, const Box& box, Touches&& touches,
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
void BodyIndex::visitCandidates(float x, float y, float z, Visitor&& visit) const {
    for (int o = 0; o < usedOctaveCount_; ++o) {
        const int octave = usedOctaves_[o];
        const BoxCells::Cell cell = BoxCells::cellOf({x, y, z}, octave);
        const Slot* slot = find(keyOf(octave, cell[0], cell[1], cell[2]));
        if (slot == nullptr) continue;
        const std::uint32_t* member = membersOf(*slot);
        for (std::uint32_t k = 0; k < slot->count; ++k) visit(member[k]);
    }
}

}  // namespace hgmm
