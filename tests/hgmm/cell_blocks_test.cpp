#include "index/cell_blocks.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <unordered_map>

namespace hgmm {
namespace {

// Few enough blocks that words fill, empty and go all the time.
TEST(CellBlocks, HoldWhatAMapOfWordsHolds) {
    std::mt19937_64 engine(3);
    std::uniform_int_distribution<int> octave(-1, 1), place(-5, 5);
    CellBlocks blocks;
    std::unordered_map<LatticeCell, CellBlocks::Word, LatticeCellHash> oracle;
    std::size_t fullSeen = 0;
    for (int step = 0; step < 30000; ++step) {
        const LatticeCell block{octave(engine), place(engine), place(engine),
                                place(engine)};
        const CellBlocks::Word cells =
            step % 3 == 0 ? CellBlocks::kAllCells
                          : std::max<CellBlocks::Word>(engine() & engine() & engine(), 1);
        if (step / 3000 % 2 == 0) {
            EXPECT_EQ(blocks.mark(block, cells), oracle[block] == 0);
            oracle[block] |= cells;
        } else {
            blocks.unmark(block, cells);
            oracle[block] &= ~cells;
        }
        if (oracle[block] == 0) oracle.erase(block);
        ASSERT_EQ(blocks.size(), oracle.size());
        if (step % 500 != 0) continue;
        std::size_t visited = 0;
        blocks.forEach([&](const LatticeCell& cell, CellBlocks::Word word) {
            ++visited;
            fullSeen += word == CellBlocks::kAllCells ? 1 : 0;
            EXPECT_EQ(word, oracle.at(cell));
            EXPECT_EQ(word, blocks.word(cell));
        });
        EXPECT_EQ(visited, oracle.size());
    }
    EXPECT_GT(fullSeen, 100U);
}

TEST(CellBlocks, ACopyIsOfItsOwn) {
    CellBlocks blocks;
    blocks.mark({0, 1, 2, 3}, 5);
    CellBlocks copy = blocks;
    blocks.unmark({0, 1, 2, 3}, 4);
    EXPECT_EQ(blocks.word({0, 1, 2, 3}), 1U);
    EXPECT_EQ(copy.word({0, 1, 2, 3}), 5U);
    EXPECT_EQ(copy.word({0, -1, 2, 3}), 0U);
}

}  // namespace
}  // namespace hgmm
