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
/// Cells lie in one table; the members of each are stored contiguously.
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
    using Placement = BoxCells;
    using Cell = BoxCells::Cell;
    /// A cell's members are pool_[begin .. begin + count); room for 1 << capacityLog2. A
    /// single one, as most cells have, is `begin` itself: capacityLog2 is 0.
    struct Members {
        std::uint32_t begin = 0;
        std::uint32_t count : 27;
        std::uint32_t capacityLog2 : 5;
        Members() : count(0), capacityLog2(0) {}
    };

    /// What a test of bodies says of a cell.
    template <typename Test>
    static bool holds(Test&& test, int octave, const Cell& cell) {
        const float edge = floatPowerOfTwo(octave);
        const float centre[3] = {(float(cell[0]) + 0.5F) * edge,
                                 (float(cell[1]) + 0.5F) * edge,
                                 (float(cell[2]) + 0.5F) * edge};
        return test(centre, 0.5F * edge);
    }
    Placement placementOf(const Box& box) const {
        return BoxCells::of(box, cells_.finer, cells_.leastOctave);
    }
    /// Notes where box i is from now on; its cells are left as they are.
    void place(std::uint32_t i, const Placement& placement);
    template <typename Visitor>
    static void forEachCell(const Placement& p, Visitor&& visit);
    const std::uint32_t* membersOf(const Members& members) const {
        return members.capacityLog2 == 0 ? &members.begin : pool_.data() + members.begin;
    }
    std::uint32_t* membersOf(Members& members) {
        return members.capacityLog2 == 0 ? &members.begin : pool_.data() + members.begin;
    }
    std::uint32_t allocate(unsigned capacityLog2);
    void add(std::uint64_t key, std::uint32_t i);
    void remove(std::uint64_t key, std::uint32_t i);

    Cells cells_;
    std::vector<Placement> placements_;
    PackedCellTable<Members> table_;
    std::vector<std::uint32_t> pool_;
    std::array<std::vector<std::uint32_t>, 32> free_;  ///< begins of unused runs, by size
    OctavesInUse octaves_;
};

template <typename Visitor>
void BodyIndex::forEachCell(const Placement& p, Visitor&& visit) {
    for (std::int32_t x = p.low[0]; x <= p.high[0]; ++x)
        for (std::int32_t y = p.low[1]; y <= p.high[1]; ++y)
            for (std::int32_t z = p.low[2]; z <= p.high[2]; ++z) visit(Cell{x, y, z});
}

template <typename Touches, typename Touched>
void BodyIndex::update(std::uint32_t i, const Box& box, Touches&& touches,
                       Touched&& touched) {
    const Placement p = placementOf(box);
    const bool isNew = i >= size(), stays = !isNew && placements_[i] == p;
    if (!isNew && !stays) {
        const Placement& old = placements_[i];
        forEachCell(old, [&](const Cell& cell) {
            if (holds(touched, old.octave, cell))
                remove(PackedCellKeys::of(old.octave, cell), i);
        });
    }
    place(i, p);
    // Most cells of a body that moved a little are those that it touched before.
    forEachCell(p, [&](const Cell& cell) {
        const bool was = stays && holds(touched, p.octave, cell);
        const bool is = holds(touches, p.octave, cell);
        if (was && !is) remove(PackedCellKeys::of(p.octave, cell), i);
        if (is && !was) add(PackedCellKeys::of(p.octave, cell), i);
    });
}

template <typename Visitor>
void BodyIndex::visitCandidates(float x, float y, float z, Visitor&& visit) const {
    for (const int octave : octaves_) {
        const Members* members =
            table_.find(PackedCellKeys::of(octave, BoxCells::cellOf({x, y, z}, octave)));
        if (members == nullptr) continue;
        const std::uint32_t* member = membersOf(*members);
        for (std::uint32_t k = 0; k < members->count; ++k) visit(member[k]);
    }
}

}  // namespace hgmm
