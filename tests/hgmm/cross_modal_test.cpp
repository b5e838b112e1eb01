#include <gtest/gtest.h>

#include <cmath>
#include <set>

#include "coloured_scenes.h"

namespace hgmm {
namespace {

using testing::mapOf;
using testing::paintedWall;
using testing::patches;
using testing::plain;

/// Three patches side by side, with centres at y = -0.4, 0, 0.4.
Map threePatches() {
    return mapOf(paintedWall({{"r", patches({0.9, 0.9, 0.1})},
                              {"g", patches({0.1, 0.9, 0.9})},
                              {"b", patches({0.2, 0.5, 0.8})}}),
                 {"r", "g", "b"});
}

TEST(CrossModal, OnePriorLeadsToThePlaceWhereItWasSeen) {  // thesis eq. (5.12)
    const Map map = threePatches();
    const CrossModalEstimate dark = map.infer("b", {{"r", 0.1}});
    ASSERT_TRUE(dark.known);
    EXPECT_NEAR(dark.mean, 0.8, 0.02);
    EXPECT_GT(dark.place_map.y(), 0.2);
    EXPECT_NEAR(dark.place_map.x(), 2, 0.02);
    EXPECT_NEAR(map.infer("b", {{"g", 0.1}}).mean, 0.2, 0.02);
}

TEST(CrossModal, TheTargetIsRegressedAtThePlace) {  // thesis eq. (5.13)
    const Map map = threePatches();
    const CrossModalEstimate e = map.infer("b", {{"r", 0.85}, {"g", 0.12}});
    const ModalityEstimate there = map.modality("b", e.place_map);
    EXPECT_EQ(e.mean, there.mean);
    EXPECT_EQ(e.variance, there.variance);
    EXPECT_GT(e.variance, 0);
}

TEST(CrossModal, PriorsAddTheirLikelihoods) {  // thesis eq. (5.14)
    const Map map = threePatches();
    const CrossModalEstimate both = map.infer("b", {{"r", 0.9}, {"g", 0.9}});
    EXPECT_NEAR(both.mean, 0.5, 0.02) << "only the middle has both";
    EXPECT_LT(std::abs(both.place_map.y()), 0.2);
    const Eigen::Vector3d local = both.place_map - map.origin();
    EXPECT_NEAR(
        both.likelihood,
        map.modality("r")->density(0.9, local) + map.modality("g")->density(0.9, local),
        1e-9 * both.likelihood);
    EXPECT_NEAR(map.infer("b", {{"r", 0.9}, {"g", 0.1}}).mean, 0.2, 0.02);
    EXPECT_NEAR(map.infer("b", {{"r", 0.1}, {"g", 0.9}}).mean, 0.8, 0.02);
}

/// No other place scores more than the one chosen.
TEST(CrossModal, ThePlaceIsTheMaximumOfTheScore) {
    const Map map = threePatches();
    const CrossModalEstimate best = map.infer("b", {{"r", 0.9}, {"g", 0.1}});
    for (double y = -0.55; y < 0.56; y += 0.01) {
        const Eigen::Vector3d local = Eigen::Vector3d(2, y, 0) - map.origin();
        const double score =
            map.modality("r")->density(0.9, local) + map.modality("g")->density(0.1, local);
        EXPECT_LE(score, 1.5 * best.likelihood);
    }
}

TEST(CrossModal, ThePlaceOfAComponentFollowsTheValue) {  // thesis eq. (5.10)
    const auto gradient = [](double y, double) { return 0.5 + 0.5 * y; };
    const Map map = mapOf(paintedWall({{"r", gradient}, {"g", gradient}}), {"r", "g"});
    for (double y = -0.45; y < 0.5; y += 0.05) {
        const double value = gradient(y, 0);
        const CrossModalEstimate e = map.infer("g", {{"r", value}});
        EXPECT_NEAR(e.place_map.y(), y, 0.06);
        EXPECT_NEAR(e.mean, value, 0.02);
    }
}

/// Two places that nothing tells apart, with different targets.
TEST(CrossModal, BetweenEqualPlacesOneIsChosenAndAlwaysTheSame) {
    const Map map = mapOf(
        paintedWall({{"r", patches({0.3, 0.8, 0.3})}, {"b", patches({0.1, 0.5, 0.9})}}),
        {"r", "b"});
    const CrossModalEstimate first = map.infer("b", {{"r", 0.3}});
    EXPECT_LT(std::min(std::abs(first.mean - 0.1), std::abs(first.mean - 0.9)), 0.03)
        << "one of both, not what lies between: " << first.mean;
    std::set<double> answers;
    for (int k = 0; k < 50; ++k) answers.insert(map.infer("b", {{"r", 0.3}}).mean);
    EXPECT_EQ(answers.size(), 1U);
    const auto buffer = map.save(Encoding::exact);
    EXPECT_EQ(Map::load(buffer.data(), buffer.size()).infer("b", {{"r", 0.3}}).mean,
              first.mean);
}

/// The priors contradict each other: no place has both.
TEST(CrossModal, ContradictoryPriorsGiveTheAnswerOfOneOfThem) {
    const Map map = mapOf(paintedWall({{"r", patches({0.9, 0.1})},
                                       {"g", patches({0.1, 0.9})},
                                       {"b", patches({0.25, 0.75})}}),
                          {"r", "g", "b"});
    const CrossModalEstimate e = map.infer("b", {{"r", 0.9}, {"g", 0.9}});
    ASSERT_TRUE(e.known);
    EXPECT_LT(std::min(std::abs(e.mean - 0.25), std::abs(e.mean - 0.75)), 0.03);
    EXPECT_EQ(map.infer("b", {{"r", 0.9}, {"g", 0.9}}).mean, e.mean);
}

TEST(CrossModal, AKnownLocationDecidesBetweenEqualPlaces) {  // thesis eq. (5.8)
    const Map map = mapOf(
        paintedWall({{"r", patches({0.3, 0.8, 0.3})}, {"b", patches({0.1, 0.5, 0.9})}}),
        {"r", "b"});
    EXPECT_NEAR(map.infer("b", {{"r", 0.3}}, Eigen::Vector3d(2, -0.35, 0)).mean, 0.1, 0.03);
    EXPECT_NEAR(map.infer("b", {{"r", 0.3}}, Eigen::Vector3d(2, 0.35, 0)).mean, 0.9, 0.03);
    EXPECT_TRUE(map.infer("b", {{"r", 0.3}}, Eigen::Vector3d(50, 0, 0)).known)
        << "where nothing was seen, as without a location";
}

/// The target was measured on a part of the wall only.
TEST(CrossModal, PlacesWithoutATargetDoNotCount) {
    Scan scan = paintedWall({{"r", patches({0.3, 0.8, 0.3})}, {"b", plain(0.6)}});
    for (std::size_t i = 0; i < scan.size(); ++i)
        if (scan.y[i] < 0) scan.channels[1].values[i] = NAN;
    const Map map = mapOf(scan, {"r", "b"});
    const CrossModalEstimate e = map.infer("b", {{"r", 0.3}});
    ASSERT_TRUE(e.known);
    EXPECT_GT(e.place_map.y(), -0.1);
    EXPECT_NEAR(e.mean, 0.6, 0.01);
}

TEST(CrossModal, ValuesThatWereNeverSeenAreNotKnown) {
    const Map map = threePatches();
    const CrossModalEstimate e = map.infer("b", {{"r", 50}});
    EXPECT_FALSE(e.known);
    EXPECT_EQ(e.likelihood, 0);
}

/// The target was measured far from all that the prior was.
TEST(CrossModal, TheTargetItselfAnswersWhereNoPlaceIsFound) {
    Scan scan = paintedWall({{"r", plain(0.3)}, {"b", plain(0.6)}});
    for (std::size_t i = 0; i < scan.size(); ++i)
        scan.channels[scan.y[i] < 0 ? 1 : 0].values[i] = NAN;
    const Map map = mapOf(scan, {"r", "b"});
    const CrossModalEstimate e =
        map.infer("b", {{"r", 50}}, Eigen::Vector3d(scan.x[0], 0.5, scan.z[0]));
    EXPECT_FALSE(e.known);
    EXPECT_NEAR(e.mean, 0.6, 0.02);
}

TEST(CrossModal, BadQuestionsGetAMessage) {
    const Map map = threePatches();
    EXPECT_THROW(map.infer("x", {{"r", 0.5}}), std::invalid_argument);
    EXPECT_THROW(map.infer("b", {{"x", 0.5}}), std::invalid_argument);
    EXPECT_THROW(map.infer("b", {}), std::invalid_argument);
    EXPECT_THROW(map.infer("b", {{"r", NAN}}), std::invalid_argument);
    EXPECT_THROW(map.infer("b", {{"r", 0.5}}, Eigen::Vector3d(NAN, 0, 0)),
                 std::invalid_argument);
    EXPECT_FALSE(Map(testing::modelling({"r", "b"})).infer("b", {{"r", 0.5}}).known);
}

/// Modalities of different scans, which share no components.
TEST(CrossModal, PriorsOfSeparateModelsWorkTogether) {
    Map map(testing::modelling({"r", "g", "b"}));
    map.insert(paintedWall({{"r", patches({0.9, 0.9, 0.1})}}, 1));
    map.insert(paintedWall({{"g", patches({0.1, 0.9, 0.9})}}, 2));
    map.insert(paintedWall({{"b", patches({0.2, 0.5, 0.8})}}, 3));
    EXPECT_NEAR(map.infer("b", {{"r", 0.9}, {"g", 0.9}}).mean, 0.5, 0.05);
    EXPECT_NEAR(map.infer("b", {{"g", 0.1}}).mean, 0.2, 0.05);
}

}  // namespace
}  // namespace hgmm
