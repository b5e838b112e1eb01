#include "hgmm/evaluation/split.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>
#include <set>
#include <stdexcept>

using namespace hgmm::evaluation;

namespace {

/// A scan whose point i is at (i, 0, 0), with a channel that holds i too.
hgmm::Scan numberedScan(std::size_t n) {
    hgmm::Scan scan;
    scan.channels.push_back({"intensity", {}});
    for (std::size_t i = 0; i < n; ++i) {
        scan.pushBack(static_cast<float>(i), 0.F, 0.F);
        scan.channels[0].values.push_back(static_cast<float>(i));
    }
    scan.T_map_sensor.t = {1.0, 2.0, 3.0};
    return scan;
}

}  // namespace

TEST(Split, TestScansAreThoseInTheMiddleOfEachGroup) {
    SplitParams split;
    split.every = 5;
    for (std::size_t i = 0; i < 20; ++i)
        EXPECT_EQ(split.isTestScan(i), i == 2 || i == 7 || i == 12 || i == 17) << i;
    split.every = 4;
    EXPECT_TRUE(split.isTestScan(2));
    EXPECT_FALSE(split.isTestScan(1));
    split.every = 0;
    for (std::size_t i = 0; i < 20; ++i) EXPECT_FALSE(split.isTestScan(i));
}

TEST(Split, RefusesValuesThatMeanNothing) {
    const auto invalid = [](auto change) {
        SplitParams split;
        change(split);
        EXPECT_THROW(split.validate(), std::invalid_argument);
    };
    invalid([](SplitParams& s) { s.every = 1; });
    invalid([](SplitParams& s) { s.every = -3; });
    invalid([](SplitParams& s) { s.subsample = 0.0; });
    invalid([](SplitParams& s) { s.subsample = 1.5; });
    invalid([](SplitParams& s) { s.subsample = std::nan(""); });
    invalid([](SplitParams& s) { s.holdoutPoints = 1.0; });
    invalid([](SplitParams& s) { s.holdoutPoints = -0.1; });
    EXPECT_NO_THROW(SplitParams{}.validate());
}

TEST(Split, ClearedRaysGoToTheMap) {
    hgmm::Scan scan = numberedScan(100);
    scan.clearedRays = {{Eigen::Vector3f::UnitX(), 2.F}, {Eigen::Vector3f::UnitZ(), 3.F}};
    SplitParams split;
    for (const double share : {0.0, 0.3}) {
        split.holdoutPoints = share;
        split.subsample = 1.0 - share;
        const SplitScan parts = splitPoints(scan, 1, split);
        ASSERT_EQ(parts.mapping.clearedRays.size(), 2U);
        EXPECT_EQ(parts.mapping.clearedRays[1].length_m, 3.F);
        EXPECT_TRUE(parts.heldOut.clearedRays.empty());
    }
}

TEST(Split, ChosenIndicesAreDistinctRisingAndOfTheRightNumber) {
    const auto chosen = chooseIndices(1000, 137, 7, 3, Draw::queries);
    ASSERT_EQ(chosen.size(), 137U);
    EXPECT_TRUE(std::is_sorted(chosen.begin(), chosen.end()));
    EXPECT_EQ(std::set<std::size_t>(chosen.begin(), chosen.end()).size(), 137U);
    EXPECT_LT(chosen.back(), 1000U);
    EXPECT_EQ(chooseIndices(10, 10, 7, 3, Draw::queries).size(), 10U);
    EXPECT_EQ(chooseIndices(10, 99, 7, 3, Draw::queries).size(), 10U);
    EXPECT_TRUE(chooseIndices(0, 5, 7, 3, Draw::queries).empty());
}

TEST(Split, ChoiceDependsOnSeedScanAndUseAlone) {
    const auto reference = chooseIndices(1000, 50, 7, 3, Draw::queries);
    EXPECT_EQ(reference, chooseIndices(1000, 50, 7, 3, Draw::queries));
    EXPECT_NE(reference, chooseIndices(1000, 50, 8, 3, Draw::queries));
    EXPECT_NE(reference, chooseIndices(1000, 50, 7, 4, Draw::queries));
    EXPECT_NE(reference, chooseIndices(1000, 50, 7, 3, Draw::holdout));
}

TEST(Split, EveryIndexIsEquallyLikely) {
    std::vector<int> count(20, 0);
    constexpr int trials = 20000;
    for (int seed = 0; seed < trials; ++seed)
        for (const std::size_t i : chooseIndices(20, 5, seed, 0, Draw::queries)) ++count[i];
    // Binomial with p = 1/4: five standard deviations are 306.
    for (const int c : count) EXPECT_NEAR(c, trials / 4, 306);
}

TEST(Split, HeldOutPointsAndMappingPointsPartitionTheScan) {
    SplitParams split;
    split.holdoutPoints = 0.2;
    const SplitScan parts = splitPoints(numberedScan(100), 4, split);
    ASSERT_EQ(parts.heldOut.size(), 20U);
    ASSERT_EQ(parts.mapping.size(), 80U);
    std::set<float> all(parts.heldOut.x.begin(), parts.heldOut.x.end());
    all.insert(parts.mapping.x.begin(), parts.mapping.x.end());
    EXPECT_EQ(all.size(), 100U);
    EXPECT_EQ(parts.mapping.channels[0].values, parts.mapping.x);
    EXPECT_EQ(parts.heldOut.channels[0].values, parts.heldOut.x);
    EXPECT_EQ(parts.mapping.T_map_sensor.t, numberedScan(1).T_map_sensor.t);
    EXPECT_EQ(parts.heldOut.T_map_sensor.t, numberedScan(1).T_map_sensor.t);
}

TEST(Split, SubsampleThinsWhatIsLeftAfterHoldingOut) {
    SplitParams split;
    split.holdoutPoints = 0.2;
    const SplitScan whole = splitPoints(numberedScan(100), 4, split);
    split.subsample = 0.25;
    const SplitScan thinned = splitPoints(numberedScan(100), 4, split);
    EXPECT_EQ(thinned.heldOut.x, whole.heldOut.x);
    ASSERT_EQ(thinned.mapping.size(), 20U);
    EXPECT_TRUE(std::includes(whole.mapping.x.begin(), whole.mapping.x.end(),
                              thinned.mapping.x.begin(), thinned.mapping.x.end()));
}

TEST(Split, WithoutFractionsTheScanIsLeftAlone) {
    const SplitScan parts = splitPoints(numberedScan(100), 4, SplitParams{});
    EXPECT_EQ(parts.mapping.x, numberedScan(100).x);
    EXPECT_EQ(parts.heldOut.size(), 0U);
}
