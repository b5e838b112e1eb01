#include "hgmm/evaluation/free_points.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "hgmm/evaluation/test_points.h"

using namespace hgmm::evaluation;

namespace {

/// Points 0.05, 0.25, 0.45, ... m ahead of a sensor at (100, 200, 5) that looks along +y.
hgmm::Scan scanOfRanges(std::size_t n) {
    hgmm::Scan scan;
    for (std::size_t i = 0; i < n; ++i)
        scan.pushBack(0.05F + 0.2F * static_cast<float>(i), 0, 0);
    scan.T_map_sensor.R << 0, -1, 0, 1, 0, 0, 0, 0, 1;
    scan.T_map_sensor.t << 100, 200, 5;
    return scan;
}

double rangeOf(const Eigen::Vector3d& point_map) {
    return point_map.y() - 200.0;
}

}  // namespace

TEST(FreePoints, NearBandOfEachKindOfSensor) {
    EXPECT_EQ(nearBandOf("mrpt::obs::CObservation3DRangeScan").min_m, 0.05);
    EXPECT_EQ(nearBandOf("mrpt::obs::CObservation3DRangeScan").max_m, 0.30);
    for (const char* lidar :
         {"mrpt::obs::CObservationPointCloud", "mrpt::obs::CObservation2DRangeScan",
          "mrpt::obs::CObservationVelodyneScan"}) {
        EXPECT_EQ(nearBandOf(lidar).min_m, 0.10) << lidar;
        EXPECT_EQ(nearBandOf(lidar).max_m, 0.60) << lidar;
    }
}

TEST(FreePoints, RangesWithinTheBandsByHand) {
    const NearBand near{0.1, 0.6};
    EXPECT_NEAR(*rangeIn(near, 3.0, 0.0), 2.4, 1e-12);
    EXPECT_NEAR(*rangeIn(near, 3.0, 0.5), 2.65, 1e-12);
    EXPECT_NEAR(*rangeIn(near, 3.0, 1.0), 2.9, 1e-12);
    EXPECT_FALSE(rangeIn(near, 0.6, 0.5));
    EXPECT_TRUE(rangeIn(near, 0.61, 0.5));
    const FreeBand free;
    EXPECT_NEAR(*rangeIn(free, 3.0, 0.0), 0.1, 1e-12);
    EXPECT_NEAR(*rangeIn(free, 3.0, 1.0), 2.85, 1e-12);
    EXPECT_FALSE(rangeIn(free, 0.25, 0.5));
    EXPECT_FALSE(rangeIn(free, 0.0, 0.5));
    const FreeBand upToHit{0.0, 0.2};
    EXPECT_NEAR(*rangeIn(upToHit, 3.0, 0.0), 0.0, 1e-12);
    EXPECT_NEAR(*rangeIn(upToHit, 3.0, 1.0), 2.8, 1e-12);
}

TEST(FreePoints, BandsAreChecked) {
    EXPECT_NO_THROW((NearBand{0.0, 0.2}.validate()));
    EXPECT_THROW((NearBand{0.3, 0.3}.validate()), std::invalid_argument);
    EXPECT_THROW((NearBand{-0.1, 0.3}.validate()), std::invalid_argument);
    EXPECT_THROW((NearBand{0.1, std::numeric_limits<double>::infinity()}.validate()),
                 std::invalid_argument);
    EXPECT_THROW((NearBand{std::nan(""), 0.3}.validate()), std::invalid_argument);
    EXPECT_NO_THROW((FreeBand{0.0, 0.0}.validate()));
    EXPECT_THROW((FreeBand{-0.1, 0.2}.validate()), std::invalid_argument);
    EXPECT_THROW((FreeBand{0.1, std::nan("")}.validate()), std::invalid_argument);
}

TEST(FreePoints, LieOnTheRaysOfTheirHitsWithinTheBands) {
    TestPoints points(5, {0.05, 0.30}, {0.1, 0.15});
    points.add(scanOfRanges(500), 0);
    points.add(scanOfRanges(500), 1);
    ASSERT_EQ(points.hits().size(), 1000U);
    // Of each scan the hits at 0.05 and 0.25 m have no near point; that at 0.25 m ends
    // where the free band would begin.
    EXPECT_EQ(points.nearFree().points_map.size(), 996U);
    EXPECT_EQ(points.uniformFree().points_map.size(), 996U);
    double least = 1.0, most = 0.0;
    for (std::size_t i = 0; i < points.nearFree().points_map.size(); ++i) {
        const Eigen::Vector3d& p = points.nearFree().points_map[i];
        const double before =
            rangeOf(points.hits()[points.nearFree().hits[i]]) - rangeOf(p);
        EXPECT_NEAR(p.x(), 100.0, 1e-9);
        EXPECT_NEAR(p.z(), 5.0, 1e-9);
        least = std::min(least, before);
        most = std::max(most, before);
    }
    EXPECT_GE(least, 0.05 - 1e-9);
    EXPECT_LT(least, 0.06) << "the whole band is used";
    EXPECT_LE(most, 0.30 + 1e-9);
    EXPECT_GT(most, 0.29);
    double shares = 0.0;
    for (std::size_t i = 0; i < points.uniformFree().points_map.size(); ++i) {
        const double ray = rangeOf(points.hits()[points.uniformFree().hits[i]]);
        const double range = rangeOf(points.uniformFree().points_map[i]);
        EXPECT_GE(range, 0.1 - 1e-9);
        EXPECT_LE(range, ray - 0.15 + 1e-9);
        shares += (range - 0.1) / (ray - 0.25) / 996.0;
    }
    EXPECT_NEAR(shares, 0.5, 5 * std::sqrt(1.0 / 12 / 996)) << "five standard errors";
}

TEST(FreePoints, AreReproducibleAndTheirClassesIndependent) {
    const auto draw = [](std::uint64_t seed, NearBand near) {
        TestPoints points(seed, near, {});
        points.add(scanOfRanges(3000), 4);
        return points;
    };
    const TestPoints a = draw(1, {0.05, 0.3}), same = draw(1, {0.05, 0.3});
    EXPECT_EQ(a.nearFree().points_map, same.nearFree().points_map);
    EXPECT_EQ(a.uniformFree().points_map, same.uniformFree().points_map);
    const TestPoints wider = draw(1, {0.1, 0.6}), other = draw(2, {0.05, 0.3});
    EXPECT_EQ(a.hits(), wider.hits());
    EXPECT_EQ(a.uniformFree().points_map, wider.uniformFree().points_map);
    EXPECT_NE(a.hits(), other.hits());
}

TEST(FreePoints, PointsThatAreNotFiniteAreNoHits) {
    hgmm::Scan scan = scanOfRanges(10);
    scan.pushBack(std::nanf(""), 0, 0);
    scan.pushBack(std::numeric_limits<float>::infinity(), 0, 0);
    TestPoints points(1);
    points.add(scan, 0);
    EXPECT_EQ(points.hits().size(), 10U);
    for (const std::size_t hit : points.nearFree().hits) EXPECT_LT(hit, 10U);
    for (const auto& p : points.nearFree().points_map) EXPECT_TRUE(p.allFinite());
}
