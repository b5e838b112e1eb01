#include "hgmm/evaluation/roc.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <stdexcept>

using namespace hgmm::evaluation;

TEST(Roc, CurveAndAreaByHand) {
    // Falling: + 0.9, - 0.8, + 0.7, + 0.3, - 0.1. Of six pairs one is the wrong way round
    // (0.7 < 0.8), and so is 0.3 < 0.8.
    const RocCurve curve = rocCurve({0.3, 0.9, 0.7}, {0.1, 0.8});
    const double expected[][2] = {{0, 0},         {0, 1.0 / 3}, {0.5, 1.0 / 3},
                                  {0.5, 2.0 / 3}, {0.5, 1},     {1, 1}};
    ASSERT_EQ(curve.size(), 6U);
    for (std::size_t i = 0; i < curve.size(); ++i) {
        EXPECT_DOUBLE_EQ(curve[i].fpr, expected[i][0]) << i;
        EXPECT_DOUBLE_EQ(curve[i].tpr, expected[i][1]) << i;
    }
    EXPECT_DOUBLE_EQ(areaUnder(curve), 4.0 / 6.0);
}

TEST(Roc, TiesBetweenTheClassesCountHalf) {
    EXPECT_DOUBLE_EQ(areaUnder(rocCurve({0.5, 0.5}, {0.5, 0.5, 0.5})), 0.5);
    // Pairs: 0.5 ties with 0.5 (half), wins over 0.2; 0.9 wins twice: 3.5 of 4.
    const RocCurve curve = rocCurve({0.5, 0.9}, {0.5, 0.2});
    EXPECT_DOUBLE_EQ(areaUnder(curve), 3.5 / 4.0);
    ASSERT_EQ(curve.size(), 4U) << "a tie is one step along both axes";
    EXPECT_DOUBLE_EQ(curve[2].fpr, 0.5);
    EXPECT_DOUBLE_EQ(curve[2].tpr, 1.0);
}

TEST(Roc, PerfectAndInvertedScores) {
    EXPECT_EQ(areaUnder(rocCurve({0.6, 0.7}, {0.1, 0.5})), 1.0);
    EXPECT_EQ(areaUnder(rocCurve({0.1, 0.5}, {0.6, 0.7})), 0.0);
}

TEST(Roc, AreaIsTheShareOfPairsInOrder) {
    std::mt19937_64 engine(3);
    std::uniform_int_distribution<int> score(0, 20);  // many ties
    std::vector<double> positives, negatives;
    for (int i = 0; i < 150; ++i) positives.push_back(score(engine) + 5);
    for (int i = 0; i < 230; ++i) negatives.push_back(score(engine));
    double pairs = 0.0;
    for (const double p : positives)
        for (const double n : negatives) pairs += p > n ? 1.0 : p == n ? 0.5 : 0.0;
    EXPECT_NEAR(areaUnder(rocCurve(positives, negatives)), pairs / (150 * 230), 1e-12);
}

TEST(Roc, TruePositiveRateAtAFalsePositiveRate) {
    // Through (0, 0.25), (0.5, 0.75), which is a tie, and (1, 1), which is another.
    const RocCurve curve = rocCurve({4, 3, 3, 1}, {3, 1});
    EXPECT_DOUBLE_EQ(tprAt(curve, 0.0), 0.25) << "the best without false positives";
    EXPECT_DOUBLE_EQ(tprAt(curve, 0.01), 0.25 + 0.01);
    EXPECT_DOUBLE_EQ(tprAt(curve, 0.05), 0.25 + 0.05);
    EXPECT_DOUBLE_EQ(tprAt(curve, 0.5), 0.75);
    EXPECT_DOUBLE_EQ(tprAt(curve, 0.75), 0.875);
    EXPECT_DOUBLE_EQ(tprAt(curve, 1.0), 1.0);
}

TEST(Roc, ThinningKeepsEndsAndShape) {
    std::vector<double> positives, negatives;
    for (int i = 0; i < 5000; ++i) {
        positives.push_back(i + 2500);
        negatives.push_back(i + 0.5);
    }
    const RocCurve curve = rocCurve(positives, negatives), few = thinned(curve, 0.01);
    EXPECT_LT(few.size(), 250U);
    EXPECT_EQ(few.front().fpr, 0.0);
    EXPECT_EQ(few.front().tpr, 0.0);
    EXPECT_EQ(few.back().fpr, 1.0);
    EXPECT_EQ(few.back().tpr, 1.0);
    EXPECT_NEAR(areaUnder(few), areaUnder(curve), 0.01);
}

TEST(BalancedAccuracy, IsTheMeanOfBothShares) {
    // 3 of 4 hits and 1 of 2 free points.
    EXPECT_DOUBLE_EQ(balancedAccuracy({0.6, 0.7, 0.9, 0.2}, {0.1, 0.8}), 0.625);
    // Exactly 0.5 is not occupied: wrong for a hit, right for a free point.
    EXPECT_DOUBLE_EQ(balancedAccuracy({0.5}, {0.5}), 0.5);
    EXPECT_DOUBLE_EQ(balancedAccuracy({0.5}, {0.6}), 0.0);
}

TEST(Roc, RefusesEmptyClassesAndNaN) {
    EXPECT_THROW(rocCurve({}, {0.5}), std::invalid_argument);
    EXPECT_THROW(rocCurve({0.5}, {}), std::invalid_argument);
    EXPECT_THROW(rocCurve({std::nan("")}, {0.5}), std::invalid_argument);
    EXPECT_THROW(balancedAccuracy({0.5}, {std::nan("")}), std::invalid_argument);
    EXPECT_THROW(balancedAccuracy({}, {0.5}), std::invalid_argument);
}
