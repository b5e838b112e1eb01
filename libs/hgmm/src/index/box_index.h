#pragma once
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <type_traits>
#include <vector>

#include "base/run_pool.h"
#include "index/box_cells.h"
#include "index/cell_order.h"

namespace hgmm {

/// Finds the boxes that may hold a point at a cost that does not depend on how many there
/// are.
///
/// A hash grid with one level per octave of size: a box is in every cell, of a size just
/// above its own largest half extent, that it touches; a query looks up one cell per level
/// in use. Cells lie in cubic blocks. A block lists its boxes once each, with the cells
/// that they touch along each axis, so that memory follows boxes and not cells.
///
/// Of a box it keeps only how far it reaches from the cell of its centre. The owner knows
/// centres, and passes the former one with every change.
///
/// @tparam kBlockShift log2 of the cells of a block along an axis, 0 to 3: 0 where many
/// boxes share a cell and a query must pass over none in vain, 3 where few do and blocks of
/// a single cell would take more than their lists
template <int kBlockShift>
class BoxIndex {
    static_assert(kBlockShift >= 0 && kBlockShift <= 3, "entries have 8 bits an axis");

 public:
    static constexpr int kMinOctave = BoxCells::kMinOctave,
                         kMaxOctave = BoxCells::kMaxOctave;
    using Box = BoxCells::Box;
    using Point = std::array<float, 3>;  ///< [m]

    /// Enters or re-enters box i, which must be < size() or the next one.
    /// @param formerCentre of a box that is re-entered; not read for a new one
    void update(std::uint32_t i, const Box& box, const Point& formerCentre);
    void add(const Box& box) { update(static_cast<std::uint32_t>(size()), box, {}); }
    /// Drops boxes n, n + 1, ...
    /// @param centreOf centreOf(i) returns the centre of box i, a Point
    template <typename CentreOf>
    void truncate(std::size_t n, CentreOf&& centreOf) {
        for (; size() > n; reaches_.pop_back()) {
            const auto i = static_cast<std::uint32_t>(size() - 1);
            leave(i, centreOf(i));
        }
    }
    void clear() { *this = BoxIndex(); }
    /// Makes room for n boxes in all.
    void reserve(std::size_t n) { reaches_.reserve(n); }
    std::size_t size() const { return reaches_.size(); }

    /// Calls visit(i) for each box in whose cells (x, y, z) lies, each once, smaller cells
    /// first and rising within a cell: an order that depends on the boxes alone.
    template <typename Visitor>
    void visitCandidates(float x, float y, float z, Visitor&& visit) const;

    /// The same for points that follow each other in few cells: calls visit(i, first, last)
    /// for each box in whose cells the points first to last - 1 lie. A point's boxes
    /// come in the order that it gets them in alone.
    template <typename Visitor>
    void visitCandidates(const CellOrder& points, std::size_t begin, std::size_t end,
                         Visitor&& visit) const;
    /// Octaves of cells in use, rising.
    const OctavesInUse& octaves() const { return octaves_; }
    /// Calls visit(i) for each box that touches a cell, rising. visitCandidates() does so
    /// for the cells of a point, octave by octave.
    template <typename Visitor>
    void visitCell(int octave, const BoxCells::Cell& cell, Visitor&& visit) const {
        const PoolRun* run = blocks_.find(keyOf(octave, cell));
        if (run != nullptr) visitCell(*run, cell, visit);
    }
    /// Octave of the smallest cells in use; 0 if there are none.
    int smallestOctave() const {
        return octaves_.begin() != octaves_.end() ? *octaves_.begin() : 0;
    }

    /// Calls visit(i) for each box in whose cells the ray from `start` along the unit
    /// vector `direction` comes within `length` [m], possibly several times.
    template <typename Visitor>
    void visitAlongRay(const float* start, const float* direction, float length,
                       Visitor&& visit) const;

    /// Heap held [bytes].
    std::size_t liveBytes() const {
        return reaches_.capacity() * sizeof(Reach) + blocks_.liveBytes() +
               entries_.liveBytes();
    }

 private:
    using Cell = BoxCells::Cell;

    /// Cells from that of the centre to the ends of a box, below and above, along an axis.
    /// Boxes are at most two cells wide, and rounding makes that five.
    struct Reach {
        std::int8_t octave = 0;
        std::array<std::uint8_t, 3> belowAndAbove{};  ///< 4 bits each
    };
    /// A box in a block. Bit 8 d + c says that it touches cell c along axis d.
    struct BoxInBlock {
        std::uint32_t box, cells;
        bool touches(std::uint32_t bits) const { return (cells & bits) == bits; }
    };
    /// The same in a block of a single cell.
    struct BoxInCell {
        std::uint32_t box;
        bool touches(std::uint32_t) const { return true; }
    };
    using Entry = std::conditional_t<kBlockShift == 0, BoxInCell, BoxInBlock>;
    static Entry entryOf(std::uint32_t box, std::uint32_t cells) {
        if constexpr (kBlockShift == 0)
            return {box};
        else
            return {box, cells};
    }

    /// Of the block that holds a cell.
    static std::uint64_t keyOf(int octave, const Cell& cell) {
        return PackedCellKeys::of(octave, {cell[0] >> kBlockShift, cell[1] >> kBlockShift,
                                           cell[2] >> kBlockShift});
    }
    /// The bits of an entry that touches a cell.
    std::uint32_t bitsOf(const Cell& cell) const;

    static Reach reachOf(const Point& centre, const BoxCells& cells);
    BoxCells cellsOf(const Point& centre, const Reach& reach) const;
    /// Calls visit(key, cells) for each block that a box touches.
    template <typename Visitor>
    void forEachBlock(const BoxCells& cells, Visitor&& visit) const;
    /// Where a box is in the list of a block, or would be entered.
    std::uint32_t placeOf(std::uint32_t i, const PoolRun& run) const;
    void enter(std::uint32_t i, const BoxCells& cells);
    void leave(std::uint32_t i, const Point& centre);
    template <typename Visitor>
    void visitCell(const PoolRun& run, const Cell& cell, Visitor&& visit) const;

    std::vector<Reach> reaches_;
    PackedCellTable<PoolRun> blocks_;  ///< rising by box
    RunPool<Entry> entries_;
    OctavesInUse octaves_;
};

template <int kBlockShift>
std::uint32_t BoxIndex<kBlockShift>::bitsOf(const Cell& cell) const {
    const std::int32_t inBlock = (1 << kBlockShift) - 1;
    return 1U << unsigned(cell[0] & inBlock) | 256U << unsigned(cell[1] & inBlock) |
           65536U << unsigned(cell[2] & inBlock);
}

template <int kBlockShift>
template <typename Visitor>
void BoxIndex<kBlockShift>::visitCell(const PoolRun& run, const Cell& cell,
                                      Visitor&& visit) const {
    constexpr std::uint32_t kAtOnce = 32;
    const Entry* entry = entries_.data(run);
    if constexpr (kBlockShift == 0) {
        for (std::uint32_t k = 0; k < run.count; ++k) visit(entry[k].box);
        return;
    }
    const std::uint32_t bits = bitsOf(cell);
    std::uint32_t found[kAtOnce];
    for (std::uint32_t left = run.count; left > 0;) {
        const std::uint32_t n = std::min(left, kAtOnce);
        std::uint32_t count = 0;
        // Without branches, which would be guessed wrong.
        for (std::uint32_t k = 0; k < n; ++k) {
            found[count] = entry[k].box;
            count += entry[k].touches(bits) ? 1 : 0;
        }
        for (std::uint32_t k = 0; k < count; ++k) visit(found[k]);
        entry += n, left -= n;
    }
}

template <int kBlockShift>
template <typename Visitor>
void BoxIndex<kBlockShift>::visitCandidates(float x, float y, float z,
                                            Visitor&& visit) const {
    for (const int octave : octaves_) {
        const Cell cell = BoxCells::cellOf({x, y, z}, octave);
        const PoolRun* run = blocks_.find(keyOf(octave, cell));
        if (run != nullptr) visitCell(*run, cell, visit);
    }
}

template <int kBlockShift>
template <typename Visitor>
void BoxIndex<kBlockShift>::visitCandidates(const CellOrder& points, std::size_t begin,
                                            std::size_t end, Visitor&& visit) const {
    for (const int octave : octaves_) {
        const auto cellAt = [&](std::size_t k) {
            return BoxCells::cellOf({points.x[k], points.y[k], points.z[k]}, octave);
        };
        Cell cell{}, following = begin < end ? cellAt(begin) : Cell{};
        std::uint64_t key = PackedCellKeys::unused();
        const PoolRun* run = nullptr;
        for (std::size_t first = begin, last = begin; first < end; first = last) {
            cell = following;
            for (++last; last < end && (following = cellAt(last)) == cell;) ++last;
            const std::uint64_t block = keyOf(octave, cell);
            if (block != key) run = blocks_.find(key = block);
            if (run == nullptr) continue;
            visitCell(*run, cell, [&](std::uint32_t i) { visit(i, first, last); });
        }
    }
}

template <int kBlockShift>
template <typename Visitor>
void BoxIndex<kBlockShift>::visitAlongRay(const float* start, const float* direction,
                                          float length, Visitor&& visit) const {
    for (const int octave : octaves_) {
        const bool walked =
            walkRay(start, direction, length, octave,
                    1000.F + 4.F * static_cast<float>(size()), [&](const Cell& cell) {
                        const PoolRun* run = blocks_.find(keyOf(octave, cell));
                        if (run != nullptr) visitCell(*run, cell, visit);
                    });
        if (walked) continue;
        for (std::uint32_t i = 0; i < size(); ++i)
            if (reaches_[i].octave == octave) visit(i);
    }
}

extern template class BoxIndex<0>;
extern template class BoxIndex<3>;

}  // namespace hgmm
