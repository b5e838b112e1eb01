#pragma once
#include <algorithm>
#include <cstddef>
#include <cstdint>

#include "base/lattice_table.h"
#include "base/run_pool.h"

namespace hgmm {

/// Marked cells of lattices, in blocks of 4 x 4 x 4 cells with one word each: bit
/// x + 4 y + 16 z is the cell (x, y, z) in its block. A block's coordinates are those of
/// its cells / 4, its octave is theirs.
///
/// Most blocks have neighbours: 4 x 4 x 4 of them share one entry of a table, and those
/// whose cells are all marked, as a third of what rays passed are, take no word.
class CellBlocks {
 public:
    using Word = std::uint64_t;
    static constexpr Word kAllCells = ~Word{0};
    static constexpr int kShift = 2;

    static LatticeCell blockOf(const LatticeCell& cell) {
        return {cell.octave, cell.x >> kShift, cell.y >> kShift, cell.z >> kShift};
    }
    /// Of a cell in its block.
    static Word bitOf(const LatticeCell& cell) { return Word{1} << placeOf(cell); }

    /// Blocks that hold cells.
    std::size_t size() const { return size_; }
    /// The cells of a block; none where there is no such block.
    Word word(const LatticeCell& block) const {
        const Group* const group = groups_.find(blockOf(block));
        return group != nullptr ? wordIn(*group, placeOf(block)) : 0;
    }
    /// Marks cells of a block, at least one. Returns whether it had none.
    bool mark(const LatticeCell& block, Word cells);
    /// Unmarks cells of a block.
    void unmark(const LatticeCell& block, Word cells);
    /// Calls visit(block, word) for each block that holds cells, in no order.
    template <typename Visitor>
    void forEach(Visitor&& visit) const {
        groups_.forEach([&](const LatticeCell& cell, const Group& group) {
            for (Word left = group.present; left != 0; left &= left - 1) {
                const int place = __builtin_ctzll(left);
                visit(LatticeCell{cell.octave, cell.x * 4 + (place & 3),
                                  cell.y * 4 + (place >> 2 & 3), cell.z * 4 + (place >> 4)},
                      wordIn(group, static_cast<unsigned>(place)));
            }
        });
    }

    std::size_t liveBytes() const { return groups_.liveBytes() + words_.liveBytes(); }

 private:
    struct Group {
        Word present = 0, full = 0;  ///< bit x + 4 y + 16 z is the block (x, y, z) in it
        PoolRun words;               ///< of blocks that are present and not full, rising
    };

    /// Of a cell in its block, or a block in its group.
    static unsigned placeOf(const LatticeCell& cell) {
        return static_cast<unsigned>((cell.x & 3) | (cell.y & 3) << 2 | (cell.z & 3) << 4);
    }
    /// Which of the words of a group is that of the block at a place.
    static unsigned rankOf(const Group& group, unsigned place) {
        return static_cast<unsigned>(
            __builtin_popcountll(group.present & ~group.full & ((Word{1} << place) - 1)));
    }
    Word wordIn(const Group& group, unsigned place) const {
        if ((group.present >> place & 1U) == 0) return 0;
        if ((group.full >> place & 1U) != 0) return kAllCells;
        return words_.data(group.words)[rankOf(group, place)];
    }

    LatticeTable<Group> groups_;
    RunPool<Word> words_;
    std::size_t size_ = 0;
};

/// The cells of a lattice from one to another, both included.
class CellRange {
 public:
    CellRange(const LatticeCell& low, const LatticeCell& high) : low_(low), high_(high) {}

    double blockCount() const {
        const LatticeCell a = CellBlocks::blockOf(low_), b = CellBlocks::blockOf(high_);
        return (1.0 + b.x - a.x) * (1.0 + b.y - a.y) * (1.0 + b.z - a.z);
    }
    template <typename Visitor>
    void forEachBlock(Visitor&& visit) const {
        const LatticeCell a = CellBlocks::blockOf(low_), b = CellBlocks::blockOf(high_);
        for (std::int32_t x = a.x; x <= b.x; ++x)
            for (std::int32_t y = a.y; y <= b.y; ++y)
                for (std::int32_t z = a.z; z <= b.z; ++z)
                    visit(LatticeCell{low_.octave, x, y, z});
    }
    /// Those of a block of the lattice.
    CellBlocks::Word cellsIn(const LatticeCell& block) const {
        using Word = CellBlocks::Word;
        const Word x = bitsOf(low_.x, high_.x, block.x),
                   y = bitsOf(low_.y, high_.y, block.y),
                   z = bitsOf(low_.z, high_.z, block.z);
        Word layer = 0, cells = 0;
        for (unsigned k = 0; k < 4; ++k)
            if ((y >> k & 1U) != 0) layer |= x << 4 * k;
        for (unsigned k = 0; k < 4; ++k)
            if ((z >> k & 1U) != 0) cells |= layer << 16 * k;
        return cells;
    }

 private:
    /// Which of the four cells of a block along an axis.
    static CellBlocks::Word bitsOf(std::int32_t low, std::int32_t high,
                                   std::int32_t block) {
        const std::int32_t first = std::max(low - 4 * block, 0),
                           last = std::min(high - 4 * block, 3);
        return last < first ? 0 : (2U << unsigned(last)) - (1U << unsigned(first));
    }

    LatticeCell low_, high_;
};

}  // namespace hgmm
