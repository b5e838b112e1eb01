#include "base/lattice_table.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <unordered_map>

namespace hgmm {
namespace {

/// Few enough cells that they are entered, found and erased again and again.
LatticeCell randomCell(std::mt19937& random) {
    std::uniform_int_distribution<int> octave(-2, 2), place(-3, 3);
    return {octave(random), place(random), place(random), place(random)};
}

TEST(LatticeTable, HoldsWhatAStandardMapHolds) {
    std::mt19937 random(7);
    LatticeTable<int> table;
    std::unordered_map<LatticeCell, int, LatticeCellHash> oracle;
    for (int step = 0; step < 50000; ++step) {
        const LatticeCell cell = randomCell(random);
        // Grows to several hundred, shrinks to almost nothing, and again.
        if (int(random() % 10U) < (step / 5000 % 2 == 0 ? 3 : 8)) {
            table.erase(cell);
            oracle.erase(cell);
        } else {
            const auto [value, isNew] = table.tryEmplace(cell, step);
            const auto expected = oracle.try_emplace(cell, step);
            ASSERT_EQ(isNew, expected.second);
            ASSERT_EQ(*value, expected.first->second);
        }
        ASSERT_EQ(table.size(), oracle.size());
        const LatticeCell other = randomCell(random);
        const auto expected = oracle.find(other);
        const int* found = table.find(other);
        ASSERT_EQ(found != nullptr, expected != oracle.end());
        if (found != nullptr) {
            ASSERT_EQ(*found, expected->second);
        }
    }
}

TEST(LatticeTable, ACopyIsOfItsOwn) {
    LatticeTable<int> table;
    for (int x = 0; x < 1000; ++x) table.tryEmplace({0, x, 0, 0}, x);
    LatticeTable<int> copy = table;
    table.erase({0, 5, 0, 0});
    *copy.tryEmplace({0, 6, 0, 0}, 0).first = -1;
    EXPECT_EQ(*copy.find({0, 5, 0, 0}), 5);
    EXPECT_EQ(*table.find({0, 6, 0, 0}), 6);
}

TEST(LatticeTable, EmptyOneFindsAndErasesNothing) {
    LatticeTable<int> table;
    EXPECT_EQ(table.find({0, 0, 0, 0}), nullptr);
    table.erase({0, 0, 0, 0});
    EXPECT_EQ(table.size(), 0U);
}

TEST(LatticeCell, HoldsItsPointInEveryOctave) {
    std::mt19937 random(3);
    std::normal_distribution<double> normal(0, 30);
    for (int i = 0; i < 2000; ++i) {
        const Eigen::Vector3d p(normal(random), normal(random), normal(random));
        LatticeCell of = LatticeCell::at(p, -6);
        for (int octave = -6; octave <= 10; ++octave, of = of.parent()) {
            const LatticeCell cell = LatticeCell::at(p, octave);
            EXPECT_TRUE(cell == of) << octave;
            const double edge = std::ldexp(1.0, octave);
            EXPECT_EQ(cell.x, std::floor(p.x() / edge));
            EXPECT_EQ(cell.y, std::floor(p.y() / edge));
            EXPECT_EQ(cell.z, std::floor(p.z() / edge));
        }
    }
    EXPECT_EQ(LatticeCell::at({-2.0, 2.0, -1e300}, 1).x, -1);
    EXPECT_EQ(LatticeCell::at({-2.0, 2.0, -1e300}, 1).y, 1);
    EXPECT_EQ(LatticeCell::at({-2.0, 2.0, -1e300}, 1).z, -1000000000);
}

}  // namespace
}  // namespace hgmm
