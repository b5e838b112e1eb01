#include "hgmm/evaluation/occupancy_figures.h"

#include <gtest/gtest.h>

#include <cmath>
#include <stdexcept>

#include "box_room.h"
#include "hgmm/evaluation/figures.h"
#include "hgmm/mrpt_bridge/observation_to_scan.h"

using namespace hgmm::evaluation;

namespace {

/// Hits on the wall x = 2 m, seen from the origin along +x.
TestPoints wall(std::size_t n) {
    hgmm::Scan scan;
    for (std::size_t i = 0; i < n; ++i) scan.pushBack(2, 0, 0);
    TestPoints points(1, {0.1, 0.6}, {0.1, 0.9});
    points.add(scan, 0);
    return points;
}

/// Answers by x alone.
template <class Function>
BatchQuery byX(Function answer) {
    return [answer](const Eigen::Vector3d* points_map, std::size_t n, Answer* answers) {
        for (std::size_t i = 0; i < n; ++i) answers[i] = answer(points_map[i].x());
    };
}

TestPoints roomPoints(hgmm::Map& map) {
    TestPoints points(3);
    for (std::size_t i = 0; i < 4; ++i) {
        const auto pose = box_room::robotPose(i);
        const auto scan = hgmm::mrpt_bridge::observationToScan(
            *box_room::pointCloud(pose, box_room::timeOfScan(i), 2000), pose);
        if (i == 2)
            points.add(*scan, i);
        else
            map.insert(*scan);
    }
    return points;
}

}  // namespace

TEST(OccupancyFigures, OfAMapThatKnowsTheWallByHand) {
    // Near points lie at x = 1.4 to 1.9, uniform ones at 0.1 to 1.1.
    const auto f = evaluateOccupancy(byX([](double x) {
                                         if (x > 1.95) return Answer{0.8, false};
                                         if (x > 1.2) return Answer{0.4, true};
                                         return Answer{0.1, false};
                                     }),
                                     wall(900));
    EXPECT_EQ(f.hits, 900U);
    EXPECT_EQ(f.nearFree, 900U);
    EXPECT_EQ(f.uniformFree, 900U);
    EXPECT_EQ(f.aucUniform, 1.0);
    EXPECT_EQ(f.aucNear, 1.0);
    EXPECT_EQ(f.balancedAccuracyNear, 1.0);
    EXPECT_NEAR(f.brier, (0.04 + 0.16) / 2, 1e-12);
    EXPECT_NEAR(f.logLoss, -(std::log(0.8) + std::log(0.6)) / 2, 1e-12);
    // The middle one of 15 bins holds both kinds: 0.6 in the mean, half of it occupied.
    EXPECT_NEAR(f.ece, (7 * 0.2 + 7 * 0.4 + 0.1) / 15, 1e-9);
    EXPECT_EQ(f.unknownShareHit, 0.0);
    EXPECT_EQ(f.unknownShareNear, 1.0);
    EXPECT_EQ(f.unknownShareFree, 0.0);
    EXPECT_GT(f.queriesPerSecond, 0.0);
}

TEST(OccupancyFigures, OfAMapThatKnowsNothing) {
    const auto f = evaluateOccupancy(byX([](double) { return Answer{}; }), wall(100));
    EXPECT_EQ(f.aucUniform, 0.5);
    EXPECT_EQ(f.aucNear, 0.5);
    EXPECT_EQ(f.balancedAccuracyNear, 0.5);
    EXPECT_EQ(f.brier, 0.25);
    EXPECT_NEAR(f.ece, 0.0, 1e-12);
    EXPECT_EQ(f.unknownShareHit, 1.0);
}

TEST(OccupancyFigures, CalibrationPairsHitsWithTheirNearPoints) {
    // The first hit is too close for a near point: only the second, answered right, counts.
    hgmm::Scan scan;
    scan.pushBack(0.3F, 0, 0);
    scan.pushBack(5, 0, 0);
    TestPoints points(1, {0.1, 0.6}, {0.0, 0.1});
    points.add(scan, 0);
    const auto f = evaluateOccupancy(byX([](double x) {
                                         return Answer{x > 4.95 ? 1.0 : 0.0, false};
                                     }),
                                     points);
    EXPECT_EQ(f.hits, 2U);
    EXPECT_EQ(f.nearFree, 1U);
    EXPECT_EQ(f.brier, 0.0);
    EXPECT_EQ(f.balancedAccuracyNear, 0.75) << "all hits count here";
}

TEST(OccupancyFigures, BatchesCoverAllPointsInOrder) {
    Points points;
    for (std::size_t i = 0; i < 2 * kQueryBatch + 345; ++i)
        points.emplace_back(double(i), 0, 0);
    std::vector<std::size_t> sizes;
    const auto answers = answersOf(
        [&](const Eigen::Vector3d* p, std::size_t n, Answer* answer) {
            sizes.push_back(n);
            for (std::size_t i = 0; i < n; ++i) answer[i].probability = p[i].x() * 1e-5;
        },
        points);
    EXPECT_EQ(sizes, (std::vector<std::size_t>{kQueryBatch, kQueryBatch, 345}));
    ASSERT_EQ(answers.size(), points.size());
    for (std::size_t i = 0; i < points.size(); ++i)
        EXPECT_EQ(answers[i].probability, double(i) * 1e-5);
}

TEST(OccupancyFigures, RefusesMissingPointsAndNonsense) {
    const auto constant = [](double p) {
        return byX([p](double) { return Answer{p, false}; });
    };
    EXPECT_THROW(evaluateOccupancy(constant(0.5), TestPoints(1)), std::invalid_argument);
    EXPECT_THROW(evaluateOccupancy(constant(1.5), wall(5)), std::invalid_argument);
    EXPECT_THROW(evaluateOccupancy(constant(std::nan("")), wall(5)), std::invalid_argument);
}

TEST(OccupancyFigures, AskTheMixtureMapWhatItSaysItself) {
    hgmm::Map map;
    const TestPoints points = roomPoints(map);
    for (const std::size_t level : {std::size_t{0}, map.levelCount() - 1}) {
        const auto answers = answersOf(queryOf(map, level), points.nearFree().points_map);
        for (std::size_t i = 0; i < answers.size(); i += 50) {
            const hgmm::Occupancy o = map.occupancy(points.nearFree().points_map[i], level);
            EXPECT_EQ(answers[i].probability, double(o.probability()));
            EXPECT_EQ(answers[i].unknown, o.unknown > 0.5F);
        }
    }
}

TEST(MapFigures, AreThoseOfTheMapAsLoadedBack) {
    hgmm::Map map;
    const TestPoints points = roomPoints(map);
    const MapFigures figures = evaluateMap(map, points, 1);
    const auto saved = map.save();
    const hgmm::Map loaded = hgmm::Map::load(saved.data(), saved.size());
    EXPECT_EQ(*figures.memory.serialized_bytes, saved.size());
    EXPECT_EQ(figures.memory.live_bytes, map.liveBytes());
    ASSERT_TRUE(figures.occupancy);
    const auto expected = evaluateOccupancy(queryOf(loaded), points);
    EXPECT_EQ(figures.occupancy->aucNear, expected.aucNear);
    EXPECT_EQ(figures.occupancy->brier, expected.brier);
    ASSERT_EQ(figures.levels.size(), map.levelCount());
    EXPECT_EQ(*figures.levels[0].aucNear, expected.aucNear);
    for (const LevelFigures& level : figures.levels) {
        EXPECT_EQ(level.components, loaded.mixture(level.level).size());
        EXPECT_EQ(level.componentsFree, loaded.freeMixture(level.level).size());
        EXPECT_EQ(level.bytes, levelBytes(loaded, level.level));
        EXPECT_EQ(*level.aucUniform,
                  evaluateOccupancy(queryOf(loaded, level.level), points).aucUniform);
    }
}

TEST(MapFigures, WithoutTestPointsOccupancyIsLeftOut) {
    hgmm::Map map;
    roomPoints(map);
    const MapFigures figures = evaluateMap(map, TestPoints(1), 1);
    EXPECT_FALSE(figures.occupancy);
    ASSERT_FALSE(figures.levels.empty());
    EXPECT_FALSE(figures.levels[0].aucNear);
}
