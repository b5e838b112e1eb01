#include <gtest/gtest.h>
#include <mrpt/maps/CHGMMOccupancyMap.h>
#include <mrpt/maps/CMultiMetricMap.h>
#include <mrpt/maps/COccupancyGridMap2D.h>
#include <mrpt/maps/CPointsMapXYZI.h>
#include <mrpt/poses/CPose2D.h>

#include <limits>
#include <set>
#include <stdexcept>
#include <thread>

#include "laser_room.h"
#include "lit_room.h"

using mrpt::maps::CHGMMOccupancyMap;
using mrpt::maps::CSimplePointsMap;
using mrpt::poses::CPose2D;
using mrpt::poses::CPose3D;

namespace {

double distanceToWalls(double x, double y) {
    return std::min(std::abs(4 - std::abs(x)), std::abs(3 - std::abs(y)));
}

struct Match {
    mrpt::tfest::TMatchingPairList pairs;
    mrpt::maps::TMatchingExtraResults results;
};

Match match2D(const CHGMMOccupancyMap& map, const mrpt::maps::CMetricMap& other,
              const CPose2D& pose, const mrpt::maps::TMatchingParams& params = {}) {
    Match match;
    map.determineMatching2D(&other, pose, match.pairs, params, match.results);
    return match;
}

Match match3D(const CHGMMOccupancyMap& map, const mrpt::maps::CMetricMap& other,
              const CPose3D& pose, const mrpt::maps::TMatchingParams& params = {}) {
    Match match;
    map.determineMatching3D(&other, pose, match.pairs, params, match.results);
    return match;
}

TEST(Matching, PairsArePointsAndTheirFeetOnTheWalls) {
    const CHGMMOccupancyMap map = laser_room::map();
    const CSimplePointsMap points = laser_room::points();
    const CPose2D pose(0.1, -0.05, 0.02);
    const Match match = match2D(map, points, pose);
    EXPECT_GT(match.results.correspondencesRatio, 0.95F);
    EXPECT_NEAR(match.results.correspondencesRatio,
                double(match.pairs.size()) / double(points.size()), 1e-6);
    double sum = 0;
    std::size_t onWall = 0;
    for (const auto& pair : match.pairs) {
        float x = 0, y = 0, z = 0;
        points.getPoint(pair.localIdx, x, y, z);
        EXPECT_EQ(pair.local.x, x);
        EXPECT_EQ(pair.local.y, y);
        EXPECT_EQ(pair.local.z, z);
        const double off_m = distanceToWalls(pair.global.x, pair.global.y);
        EXPECT_LT(off_m, 0.25) << "a component may round a corner";
        if (off_m < 0.05) ++onWall;
        EXPECT_NEAR(pair.global.z, 0.2, 0.05);
        const auto moved = pose + mrpt::math::TPoint2D(x, y);
        EXPECT_NEAR(
            pair.errorSquareAfterTransformation,
            mrpt::square(moved.x - pair.global.x) + mrpt::square(moved.y - pair.global.y),
            1e-4);
        EXPECT_LT(pair.globalIdx, map.model().mixture().size());
        sum += pair.errorSquareAfterTransformation;
    }
    EXPECT_GT(double(onWall), 0.9 * double(match.pairs.size()));
    EXPECT_NEAR(match.results.sumSqrDist, sum / double(match.pairs.size()), 1e-6);
}

TEST(Matching, TakesEveryNthPointFromTheOffset) {
    const CHGMMOccupancyMap map = laser_room::map();
    mrpt::maps::TMatchingParams params;
    params.decimation_other_map_points = 7;
    params.offset_other_map_points = 3;
    const Match match = match2D(map, laser_room::points(), {}, params);
    ASSERT_GT(match.pairs.size(), 20U);
    for (const auto& pair : match.pairs) EXPECT_EQ(pair.localIdx % 7, 3U);
    EXPECT_GT(match.results.correspondencesRatio, 0.95F);
    EXPECT_LE(match.results.correspondencesRatio, 1.F);

    params.offset_other_map_points = 7;
    EXPECT_THROW(match2D(map, laser_room::points(), {}, params), std::invalid_argument);
    params.decimation_other_map_points = 0;
    EXPECT_THROW(match2D(map, laser_room::points(), {}, params), std::invalid_argument);
}

TEST(Matching, ThresholdGrowsWithTheDistanceFromThePivot) {
    const CHGMMOccupancyMap map = laser_room::map();
    CSimplePointsMap points;
    points.insertPoint(3.7F, 0.F, 0.F);  // 0.3 m before the wall, 3.7 m from the middle
    mrpt::maps::TMatchingParams params;
    params.maxDistForCorrespondence = 0.25F;
    EXPECT_TRUE(match2D(map, points, {}, params).pairs.empty());
    params.maxAngularDistForCorrespondence = 0.03F;  // 0.11 m more
    EXPECT_EQ(match2D(map, points, {}, params).pairs.size(), 1U);
    params.angularDistPivotPoint = {3, 0, 0};  // 0.02 m more
    EXPECT_TRUE(match2D(map, points, {}, params).pairs.empty());
    params.maxDistForCorrespondence = 0;
    params.maxAngularDistForCorrespondence = 0;
    EXPECT_TRUE(match2D(map, points, {}, params).pairs.empty());
}

TEST(Matching, UniqueRobustLeavesOnePointToTheEndOfASurface) {
    CHGMMOccupancyMap map;
    map.insertObservation(*observations::laser());  // the half of the room before it
    CSimplePointsMap points;
    for (const float y : {-0.2F, 0.F, 0.1F}) points.insertPoint(2.F, 3.F + y, 0.F);
    for (const float x : {-0.9F, -0.8F, -0.7F}) points.insertPoint(x, 3.F, 0.F);
    mrpt::maps::TMatchingParams params;
    params.maxDistForCorrespondence = 1.5F;
    const Match all = match2D(map, points, {}, params);
    ASSERT_EQ(all.pairs.size(), 6U);
    params.onlyUniqueRobust = true;
    const Match unique = match2D(map, points, {}, params);
    std::set<std::pair<float, float>> projections;
    for (const auto& pair : unique.pairs)
        EXPECT_TRUE(projections.emplace(pair.global.x, pair.global.y).second);
    std::set<unsigned> kept;
    for (const auto& pair : unique.pairs) kept.insert(pair.localIdx);
    EXPECT_TRUE(kept.count(5)) << "the closest to the end";
    EXPECT_FALSE(kept.count(3));
    EXPECT_EQ(unique.results.correspondencesRatio, 1.F);
}

TEST(Matching, OtherMapMayBeOfSeveralClasses) {
    const CHGMMOccupancyMap map = laser_room::map();
    const CSimplePointsMap points = laser_room::points();
    const Match expected = match2D(map, points, {});

    mrpt::maps::CPointsMapXYZI withIntensity;
    withIntensity.insertAnotherMap(&points, CPose3D());
    EXPECT_EQ(match2D(map, withIntensity, {}).pairs, expected.pairs);

    mrpt::maps::CMultiMetricMap several;
    several.maps.push_back(std::make_shared<CSimplePointsMap>(points));
    EXPECT_EQ(match2D(map, several, {}).pairs, expected.pairs);

    const Match means = match3D(map, map, CPose3D());
    EXPECT_EQ(means.pairs.size(), map.model().mixture().size());
    EXPECT_LT(means.results.sumSqrDist, 1e-4F);
}

TEST(Matching, ForeignMapsAreRefusedByName) {
    const CHGMMOccupancyMap map = laser_room::map();
    const mrpt::maps::COccupancyGridMap2D grid;
    try {
        match2D(map, grid, {});
        FAIL() << "not refused";
    } catch (const std::runtime_error& e) {
        EXPECT_NE(std::string(e.what()).find("COccupancyGridMap2D"), std::string::npos);
        EXPECT_NE(std::string(e.what()).find("points map"), std::string::npos);
    }
    Match match;
    EXPECT_THROW(map.determineMatching3D(nullptr, {}, match.pairs, {}, match.results),
                 std::runtime_error);
    EXPECT_THROW(map.compute3DMatchingRatio(&grid, {}, {}), std::runtime_error);
}

TEST(Matching, NothingToMatchGivesNoPairsAndRatioZero) {
    const CHGMMOccupancyMap map = laser_room::map(), empty;
    const CSimplePointsMap points = laser_room::points(), none;
    const double nan = std::numeric_limits<double>::quiet_NaN();
    for (const Match& match :
         {match2D(empty, points, {}), match2D(map, none, {}), match2D(map, empty, {}),
          match2D(map, points, CPose2D(1e4, 0, 0)),
          match3D(map, points, {0, 0, 9, 0, 0, 0}),
          match2D(map, points, CPose2D(nan, 0, 0))}) {
        EXPECT_TRUE(match.pairs.empty());
        EXPECT_EQ(match.results.correspondencesRatio, 0.F);
        EXPECT_EQ(match.results.sumSqrDist, 0.F);
    }
    EXPECT_EQ(empty.compute3DMatchingRatio(&points, {}, {}), 0.F);
}

TEST(Matching, PointsThatAreNotFiniteAreLeftOut) {
    const CHGMMOccupancyMap map = laser_room::map();
    CSimplePointsMap points = laser_room::points();
    const Match clean = match2D(map, points, {});
    const float nan = std::numeric_limits<float>::quiet_NaN();
    points.insertPoint(nan, 0.F, 0.F);
    points.insertPoint(0.F, std::numeric_limits<float>::infinity(), 0.F);
    const Match match = match2D(map, points, {});
    EXPECT_EQ(match.pairs, clean.pairs);
    EXPECT_EQ(match.results.correspondencesRatio, clean.results.correspondencesRatio);
    EXPECT_EQ(match.results.sumSqrDist, clean.results.sumSqrDist);
}

TEST(Matching, RatioIsTheShareOfPointsNearASurface) {
    const CHGMMOccupancyMap map = lit_room::map();
    const auto& at = lit_room::kMiddle_map;
    const CPose3D pose(at.x(), at.y(), at.z(), 0, 0, 0);
    CSimplePointsMap points;
    points.insertAnotherMap(lit_room::scan({0, 0, 0}, 9)->pointcloud.get(), CPose3D());
    EXPECT_GT(map.compute3DMatchingRatio(&points, pose, {}), 0.95F);
    const std::size_t n = points.size();
    for (std::size_t i = 0; i < 3 * n; ++i) points.insertPoint(0.F, 0.F, 0.F);
    EXPECT_NEAR(map.compute3DMatchingRatio(&points, pose, {}), 0.25F, 0.015F);
}

TEST(Matching, SquareDistanceIsThatToTheNearestWall) {
    for (const double east_m : {0.0, 3000.0}) {
        const CHGMMOccupancyMap map = laser_room::map(CPose3D(east_m, 0, 0.2, 0, 0, 0));
        for (const float x : {-4.8F, -2.F, 0.F, 1.5F, 3.5F, 7.F})
            for (const float y : {-2.9F, -1.F, 0.2F, 2.F}) {
                const double outside = std::max(0.0, std::abs(double(x)) - 4);
                // Near a corner, from outside: surfaces end softly there.
                if (outside > 0 && std::abs(y) > 1) continue;
                const double expected = outside > 0 ? outside : distanceToWalls(x, y);
                const float squared =
                    map.squareDistanceToClosestCorrespondence(float(east_m) + x, y);
                EXPECT_NEAR(std::sqrt(squared), expected, 0.05) << x << ", " << y;
            }
    }
    EXPECT_TRUE(
        std::isinf(CHGMMOccupancyMap().squareDistanceToClosestCorrespondence(0, 0)));
    EXPECT_TRUE(std::isinf(laser_room::map().squareDistanceToClosestCorrespondence(
        std::numeric_limits<float>::quiet_NaN(), 0)));
}

TEST(Matching, DistanceToSurfaceIsThatOfTheModel) {
    const CHGMMOccupancyMap map = laser_room::map();
    for (const double x : {-3.7, -2.0, 1.0, 3.0}) {
        const mrpt::math::TPoint3D p(x, 0.4, 0.3);
        const hgmm::SurfaceDistance expected = map.model().distance({p.x, p.y, p.z});
        double distance = 0, alone = 0, stdDev = 0;
        mrpt::math::TVector3D gradient;
        EXPECT_TRUE(map.getDistanceToSurface(p, distance, gradient, stdDev));
        EXPECT_TRUE(map.getDistanceToSurface(p, alone));
        EXPECT_EQ(distance, expected.distance_m);
        EXPECT_EQ(alone, distance);
        EXPECT_EQ(gradient.x, expected.gradient.x());
        EXPECT_EQ(gradient.y, expected.gradient.y());
        EXPECT_EQ(gradient.z, expected.gradient.z());
        EXPECT_EQ(stdDev, expected.std_m);
        EXPECT_GT(stdDev, 0.0);
    }
    double distance = 0;
    EXPECT_FALSE(map.getDistanceToSurface({0, 0, 0.2}, distance, 0.5));
    EXPECT_EQ(distance, 0.5) << "the cut-off";
    EXPECT_THROW(map.getDistanceToSurface({0, 0, 0.2}, distance, -1.0),
                 std::invalid_argument);
}

TEST(Matching, FollowsTheMap) {
    CHGMMOccupancyMap map;
    map.insertObservation(*observations::laser());
    const float before = map.squareDistanceToClosestCorrespondence(-3.8F, 0.F);
    const CHGMMOccupancyMap half = map;
    EXPECT_GT(before, 1.F);
    EXPECT_TRUE(
        match3D(map, laser_room::points(), CPose3D(0, 0, 0, M_PI, 0, 0)).pairs.size() <
        160);
    map.insertObservation(*observations::laser(), CPose3D(0, 0, 0, M_PI, 0, 0));
    EXPECT_LT(map.squareDistanceToClosestCorrespondence(-3.8F, 0.F), 0.06F);
    EXPECT_GT(match3D(map, laser_room::points(), CPose3D(0, 0, 0, M_PI, 0, 0)).pairs.size(),
              170U);
    EXPECT_EQ(half.squareDistanceToClosestCorrespondence(-3.8F, 0.F), before);
    map.model() = half.model();
    EXPECT_EQ(map.squareDistanceToClosestCorrespondence(-3.8F, 0.F), before);
    map.clear();
    EXPECT_TRUE(std::isinf(map.squareDistanceToClosestCorrespondence(-3.8F, 0.F)));
}

TEST(Matching, ThreadsGetTheSameAsOneThread) {
    const CHGMMOccupancyMap map = laser_room::map();
    const CSimplePointsMap points = laser_room::points();
    const auto ratios = [&points](const CHGMMOccupancyMap& m) {
        std::vector<float> result;
        for (int i = 0; i < 50; ++i) {
            const Match match = match2D(m, points, CPose2D(0.01 * i, 0, 0.01 * i));
            result.push_back(match.results.sumSqrDist);
        }
        return result;
    };
    std::vector<std::vector<float>> parallel(4);
    std::vector<std::thread> pool;
    for (auto& result : parallel) pool.emplace_back([&] { result = ratios(map); });
    for (auto& thread : pool) thread.join();
    const auto expected = ratios(CHGMMOccupancyMap(map));
    for (const auto& result : parallel) EXPECT_EQ(result, expected);
}

}  // namespace
