#pragma once
#include <array>
#include <cstddef>
#include <cstdint>

#include "base/lattice_table.h"
#include "hgmm/known_cells.h"

namespace hgmm {

/// A set of cells of a lattice, by their coordinates [cells]: one word for 4 x 4 x 4 cells.
class CellSet {
 public:
    using Cell = std::array<std::int32_t, 3>;

    /// Throws std::invalid_argument if the set would take more than kMaxBlocks words.
    void add(const CellCube& cube);
    /// Removes the cells of another set.
    void subtract(const CellSet& other);

    bool contains(const Cell& cell) const;
    /// Whether all, or any, of the cells of a box are in the set; both corners belong to
    /// the box.
    bool containsAll(const Cell& low, const Cell& high) const;
    bool containsAny(const Cell& low, const Cell& high) const;

    bool empty() const { return blocks_.size() == 0; }
    /// Calls visit(cell) for each cell, in an order that depends on how the set was made.
    template <typename Visitor>
    void forEach(Visitor&& visit) const {
        blocks_.forEach([&](const LatticeCell& block, std::uint64_t word) {
            for (; word != 0; word &= word - 1) {
                const int bit = __builtin_ctzll(word);
                visit(Cell{block.x * 4 + (bit & 3), block.y * 4 + (bit >> 2 & 3),
                           block.z * 4 + (bit >> 4)});
            }
        });
    }

 private:
    static constexpr std::size_t kMaxBlocks = std::size_t{1} << 24U;
    void requireRoomFor(double blocks) const;
    /// Calls visit(block, mask of the box's cells in it) until it returns false.
    template <typename Visitor>
    static void forEachBlock(const Cell& low, const Cell& high, Visitor&& visit);

    LatticeTable<std::uint64_t> blocks_;
};

}  // namespace hgmm
