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
    /// Of a cell in its block, or a block in its group.
    static unsigned placeOf(const LatticeCell& cell) {
        return static_cast<unsigned>((cell.x & 3) | (cell.y & 3) << 2 | (cell.z & 3) << 4);
    }
    /// Of a cell in its block.
    static Word bitOf(const LatticeCell& cell) { return Word{1} << placeOf(cell); }

    /// The cells of 4 x 4 x 4 blocks, until the next change.
    class GroupView;
    /// Blocks that hold cells.
    std::size_t size() const { return size_; }
    /// The cells of a block; none where there is no such block.
    Word word(const LatticeCell& block) const;
    /// The blocks of a group, whose coordinates are theirs / 4.
    GroupView group(const LatticeCell& group) const;
    /// Marks cells of a block, at least one. Returns whether it had none.
    bool mark(const LatticeCell& block, Word cells) {
        return mark(groupToMark(blockOf(block)), placeOf(block), cells);
    }
    /// To mark several blocks of a group, all at once: it holds until another one is asked
    /// for.
    struct Group {
        Word present = 0, full = 0;  ///< bit x + 4 y + 16 z is the block (x, y, z) in it
        PoolRun words;               ///< of blocks that are present and not full, rising
    };
    Group& groupToMark(const LatticeCell& group);
    bool mark(Group& group, unsigned place, Word cells) {
        return (cells & ~wordIn(group, place)) != 0 && markNew(group, place, cells);
    }
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
    static const Group kNoBlocks;

    /// Marks cells of which at least one is not marked.
    bool markNew(Group& group, unsigned place, Word cells);
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

class CellBlocks::GroupView {
 public:
    bool empty() const { return group_->present == 0; }
    /// The cells of the block at a place, x + 4 y + 16 z in the group.
    Word word(unsigned place) const { return blocks_->wordIn(*group_, place); }

 private:
    friend class CellBlocks;
    GroupView(const CellBlocks& blocks, const Group& group)
        : blocks_(&blocks), group_(&group) {}

    const CellBlocks* blocks_;
    const Group* group_;
};

inline CellBlocks::GroupView CellBlocks::group(const LatticeCell& group) const {
    const Group* const found = groups_.find(group);
    return {*this, found != nullptr ? *found : kNoBlocks};
}

inline CellBlocks::Word CellBlocks::word(const LatticeCell& block) const {
    return group(blockOf(block)).word(placeOf(block));
}

/// Calls visit(cell) for the cells of a block that a word has.
template <typename Visitor>
void forEachCell(const LatticeCell& block, CellBlocks::Word word, Visitor&& visit) {
    for (; word != 0; word &= word - 1) {
        const int bit = __builtin_ctzll(word);
        visit(LatticeCell{block.octave, block.x * 4 + (bit & 3),
                          block.y * 4 + (bit >> 2 & 3), block.z * 4 + (bit >> 4)});
    }
}

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
        blocks().forEachCell(visit);
    }
    /// The same by groups of 4 x 4 x 4 blocks, those of which isWanted(group) holds.
    template <typename Predicate, typename Visitor>
    void forEachBlock(Predicate&& isWanted, Visitor&& visit) const {
        const CellRange own = blocks();
        own.blocks().forEachCell([&](const LatticeCell& group) {
            if (isWanted(group)) own.within(group).forEachCell(visit);
        });
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
    CellRange blocks() const {
        return {CellBlocks::blockOf(low_), CellBlocks::blockOf(high_)};
    }
    /// Those within a block.
    CellRange within(const LatticeCell& block) const {
        const LatticeCell& a = low_;
        const LatticeCell& b = high_;
        const std::int32_t x = 4 * block.x, y = 4 * block.y, z = 4 * block.z;
        return {
            {a.octave, std::max(a.x, x), std::max(a.y, y), std::max(a.z, z)},
            {a.octave, std::min(b.x, x + 3), std::min(b.y, y + 3), std::min(b.z, z + 3)}};
    }
    template <typename Visitor>
    void forEachCell(Visitor&& visit) const {
        for (std::int32_t x = low_.x; x <= high_.x; ++x)
            for (std::int32_t y = low_.y; y <= high_.y; ++y)
                for (std::int32_t z = low_.z; z <= high_.z; ++z)
                    visit(LatticeCell{low_.octave, x, y, z});
    }
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
