#include <gtest/gtest.h>
#include <mrpt/maps/CHGMMOccupancyMap.h>

#include <limits>

#include "hgmm/mrpt_bridge/observation_to_scan.h"
#include "observation/shared_samples.h"
#include "observations.h"
#include "options/point_warnings.h"
#include "options/warnings.h"

using hgmm::ClearedRay;
using hgmm::Scan;
using hgmm::mrpt_bridge::Channels;
using hgmm::mrpt_bridge::observationToScan;
using hgmm::mrpt_bridge::ReadingParams;
using hgmm::mrpt_bridge::sharedSamplesOf;
using mrpt::maps::CHGMMOccupancyMap;

namespace {

constexpr float kInfinite = std::numeric_limits<float>::infinity();
constexpr float kNoNumber = std::numeric_limits<float>::quiet_NaN();

Scan read(const mrpt::obs::CObservation& o, const ReadingParams& reading = {}) {
    Scan scan = observationToScan(o, std::nullopt, Channels::none, reading).value();
    scan.validate();
    return scan;
}

void expectRay(const ClearedRay& ray, double x, double y, double z) {
    const Eigen::Vector3f end = ray.length_m * ray.direction;
    EXPECT_LT((end - Eigen::Vector3d(x, y, z).cast<float>()).norm(), 1e-4F)
        << end.transpose();
}

/// Rays at -90, 0 and 90 deg.
mrpt::obs::CObservation2DRangeScan::Ptr threeRays(std::vector<float> ranges,
                                                  std::vector<bool> valid) {
    auto o = mrpt::obs::CObservation2DRangeScan::Create();
    o->aperture = static_cast<float>(M_PI);
    o->maxRange = 10;
    o->resizeScanAndAssign(3, 0.F, false);
    for (std::size_t i = 0; i < 3; ++i) {
        o->setScanRange(i, ranges[i]);
        o->setScanRangeValidity(i, valid[i]);
    }
    return o;
}

TEST(ClearedRaysOf2D, RaysWithoutReturnClearAShareOfWhatIsSeenBeside) {
    const auto o = threeRays({0.F, 4.F, -1.F}, {false, true, true});
    const Scan scan = read(*o);
    ASSERT_EQ(scan.size(), 1U);
    EXPECT_FLOAT_EQ(scan.x[0], 4.F);
    ASSERT_EQ(scan.clearedRays.size(), 2U);
    expectRay(scan.clearedRays[0], 0, -2, 0);
    expectRay(scan.clearedRays[1], 0, 2, 0);

    ReadingParams reading;
    reading.clearedShareOfRange = 0.25;
    expectRay(read(*o, reading).clearedRays.at(1), 0, 1, 0);
    reading.considerInvalidRangesAsFreeSpace = false;
    EXPECT_TRUE(read(*o, reading).clearedRays.empty());
    EXPECT_EQ(read(*o, reading).size(), 1U);

    // The longer side; a reading at maxRange; nothing at all.
    expectRay(read(*threeRays({2.F, 0.F, 6.F}, {true, false, true})).clearedRays.at(0), 3,
              0, 0);
    expectRay(read(*threeRays({2.F, 0.F, 40.F}, {true, false, true})).clearedRays.at(1), 5,
              0, 0);
    expectRay(read(*threeRays({0.F, 0.F, 0.F}, {false, false, false})).clearedRays.at(1), 5,
              0, 0);
}

TEST(ClearedRaysOf2D, ADarkPatchOfAWallIsNotSeenThrough) {
    // maxRange is far beyond the room, as with most lasers.
    const auto o = observations::laser();
    ASSERT_EQ(o->maxRange, 80.F);
    for (const std::size_t i : {0U, 40U, 41U, 42U, 90U, 180U})
        o->setScanRangeValidity(i, false);
    const Scan scan = read(*o);
    ASSERT_EQ(scan.clearedRays.size(), 6U);
    for (const ClearedRay& ray : scan.clearedRays) {
        const double wall = observations::wallRange(
            std::atan2(double(ray.direction.y()), double(ray.direction.x())));
        EXPECT_LT(ray.length_m, 0.6 * wall);
        EXPECT_GT(ray.length_m, 0.4 * wall);
    }
}

TEST(ClearedRaysOf2D, AReadingAtMaxRangeIsNoWall) {
    const auto o = threeRays({10.F, 9.9999F, 40.F}, {true, true, true});
    ReadingParams off;
    off.considerInvalidRangesAsFreeSpace = false;
    for (const ReadingParams& reading : {ReadingParams(), off}) {
        const Scan scan = read(*o, reading);
        EXPECT_EQ(scan.size(), 0U);
        ASSERT_EQ(scan.clearedRays.size(), 3U);
        expectRay(scan.clearedRays[0], 0, -10, 0);
        expectRay(scan.clearedRays[1], 10, 0, 0);
        expectRay(scan.clearedRays[2], 0, 10, 0);
    }
    o->setScanRange(1, 9.9F);
    EXPECT_EQ(read(*o).size(), 1U) << "a hit just before it";
    const auto endless = threeRays({kInfinite, kNoNumber, 2.F}, {true, true, true});
    ASSERT_EQ(read(*endless).clearedRays.size(), 1U) << "not a number says nothing";
    expectRay(read(*endless).clearedRays[0], 0, -10, 0);
}

TEST(ClearedRaysOf2D, AnInvalidRayClearsNoFartherThanWhatItHolds) {
    const Scan scan = read(*threeRays({0.5F, 10.F, kNoNumber}, {false, false, false}));
    EXPECT_EQ(scan.size(), 0U);
    ASSERT_EQ(scan.clearedRays.size(), 3U);
    expectRay(scan.clearedRays[0], 0, -0.5, 0);
    expectRay(scan.clearedRays[1], 5, 0, 0);
    expectRay(scan.clearedRays[2], 0, 5, 0);
}

TEST(ClearedRaysOf2D, GoWhereTheHitsGo) {
    // A sweeping laser that turns clockwise: a ray's direction is that of its reading,
    // and without any return the length is the reading's, too.
    const auto o = observations::laser();
    o->rightToLeft = false;
    o->deltaPitch = 0.3;
    const Scan hits = read(*o);
    for (std::size_t i = 0; i < o->getScanSize(); ++i) o->setScanRangeValidity(i, false);
    const Scan cleared = read(*o);
    ASSERT_EQ(cleared.clearedRays.size(), hits.size());
    for (std::size_t i = 0; i < hits.size(); ++i)
        expectRay(cleared.clearedRays[i], hits.x[i], hits.y[i], hits.z[i]);
}

TEST(ClearedRaysOf2D, WithoutAMaxRangeNothingIsKnown) {
    for (const float maxRange : {0.F, -1.F, kNoNumber, kInfinite}) {
        const auto o = threeRays({0.F, 4.F, 100.F}, {false, true, true});
        o->maxRange = maxRange;
        EXPECT_EQ(read(*o).size(), 2U);
        EXPECT_TRUE(read(*o).clearedRays.empty());
    }
}

TEST(ClearedRaysOf3D, ZeroPixelsSayNothingAndThoseAtMaxRangeClear) {
    auto o = observations::depthImage();
    o->maxRange = 5;
    o->rangeUnits = 0.001F;
    o->range_is_depth = true;
    const std::size_t pixels = read(*o).size();
    EXPECT_TRUE(read(*o).clearedRays.empty());
    o->rangeImage(0, 0) = 0;
    o->rangeImage(25, 31) = 5000;  // on the axis
    o->rangeImage(25, 1) = 9000;   // (31 - 1) / 60 to the left
    const Scan scan = read(*o);
    EXPECT_EQ(scan.size(), pixels - 3);
    ASSERT_EQ(scan.clearedRays.size(), 2U);
    const double norm = std::sqrt(1 + 0.25);
    expectRay(scan.clearedRays[0], 5 / norm, 2.5 / norm, 0);
    expectRay(scan.clearedRays[1], 5, 0, 0);
}

TEST(ClearedRaysOf3D, PointsAtMaxRangeClear) {
    auto o = mrpt::obs::CObservation3DRangeScan::Create();
    o->maxRange = 5;
    o->hasPoints3D = true;
    o->points3D_x = {2, 5, 0, 4};
    o->points3D_y = {0, 5, 0, 4};
    o->points3D_z = {0, 0, 0, 0};
    for (const bool isDepth : {true, false}) {
        o->range_is_depth = isDepth;
        const Scan scan = read(*o);
        EXPECT_EQ(scan.size(), isDepth ? 2U : 1U);
        ASSERT_EQ(scan.clearedRays.size(), isDepth ? 1U : 2U);
        expectRay(scan.clearedRays[0], 5 / std::sqrt(2), 5 / std::sqrt(2), 0);
    }
}

TEST(ClearedRaysOfRotating, ZeroIsNoReturnIfAsked) {
    ReadingParams on;
    on.considerNoReturnsAsFreeSpace = true;
    for (const uint16_t rows : {uint16_t{1}, uint16_t{16}}) {
        auto o = observations::rotating(rows, 181);
        o->maxRange = 60;
        const Scan full = read(*o, on);
        EXPECT_TRUE(full.clearedRays.empty());
        const std::size_t ahead = 90U * rows;  // the first point of the column
        o->rangeImage(0, 90) = 0;
        EXPECT_TRUE(read(*o).clearedRays.empty()) << "off by default";
        const Scan scan = read(*o, on);
        EXPECT_EQ(scan.size(), full.size() - 1);
        ASSERT_EQ(scan.clearedRays.size(), 1U);
        const Eigen::Vector3d hit(full.x[ahead], full.y[ahead], full.z[ahead]);
        // In the flat of the room all neighbours are 4 m away or a little more.
        const Eigen::Vector3d end = 2 * hit.normalized();
        expectRay(scan.clearedRays[0], end.x(), end.y(), end.z());
    }
}

TEST(ClearedRaysOfRotating, ColumnsThatWereNotFiredClearNothing) {
    ReadingParams on;
    on.considerNoReturnsAsFreeSpace = true;
    auto o = observations::rotating(16, 181);
    for (int row = 0; row < 16; ++row) o->rangeImage(row, 7) = 0;
    EXPECT_TRUE(read(*o, on).clearedRays.empty());
    // Of a revolution made from packets, most of the image is empty.
    const auto recorded = observations::recordedRotating();
    ASSERT_TRUE(recorded);
    const Scan scan = read(*recorded, on);
    EXPECT_GT(scan.size(), 100U);
    EXPECT_LE(scan.size() + scan.clearedRays.size(),
              std::size_t{recorded->columnCount} * recorded->rowCount);
    if (recorded->columnCount % (12 * 32) == 0) {
        EXPECT_LE(scan.size() + scan.clearedRays.size(), recorded->columnCount);
    }
}

TEST(ClearedRaysOfRotating, AReadingAtMaxRangeIsNoHit) {
    auto o = observations::rotating(1, 181);
    o->maxRange = 20;
    o->rangeImage(0, 90) = 10000;  // 2 mm each
    const Scan scan = read(*o);
    EXPECT_EQ(scan.size(), 180U);
    ASSERT_EQ(scan.clearedRays.size(), 1U);
    expectRay(scan.clearedRays[0], 20, 0, 0);
}

TEST(ClearedRaysOfClouds, AreNone) {
    ReadingParams on;
    on.considerNoReturnsAsFreeSpace = true;
    EXPECT_TRUE(read(*observations::cloud(), on).clearedRays.empty());
    EXPECT_TRUE(read(*observations::velodyne(), on).clearedRays.empty());
}

TEST(ClearedRaysOfMaps, OptionsAndMaxRangeTellSharedSamplesApart) {
    const auto o = threeRays({0.F, 4.F, 0.F}, {false, true, false});
    const auto samples = sharedSamplesOf(*o, {}, {});
    ASSERT_EQ(samples->clearedRays_sensor.size(), 2U);
    EXPECT_EQ(sharedSamplesOf(*o, {}, {}), samples);
    ReadingParams off;
    off.considerInvalidRangesAsFreeSpace = false;
    EXPECT_TRUE(sharedSamplesOf(*o, {}, off)->clearedRays_sensor.empty());
    o->maxRange = 6;
    EXPECT_NE(sharedSamplesOf(*o, {}, {}), samples);
    hgmm::mrpt_bridge::forgetSharedSamples();
}

TEST(ClearedRaysOfMaps, AScanOutOfRangeIsReportedOnce) {
    hgmm::mrpt_bridge::forgetWarnings();
    ::testing::internal::CaptureStderr();
    CHGMMOccupancyMap map;
    map.insertObservation(*threeRays({0.F, 4.F, 0.F}, {false, true, false}));
    map.insertionOptions.params.filter.maxRange_m = 1;
    const auto far = threeRays({2.F, 4.F, 3.F}, {true, true, true});
    EXPECT_TRUE(map.insertObservation(*far)) << "its rays are cut, not dropped";
    map.insertScan(*observationToScan(*far));
    const std::string said = ::testing::internal::GetCapturedStderr();
    const std::string text =
        "all points of a scan are farther than maxRange_m = 1 [m]: no surface was added";
    EXPECT_NE(said.find(text), std::string::npos) << said;
    EXPECT_EQ(said.find("no surface"), said.rfind("no surface")) << said;
}

TEST(ClearedRaysOfMaps, AScanOfTooManySamplesIsReported) {
    hgmm::mrpt_bridge::forgetWarnings();
    ::testing::internal::CaptureStderr();
    hgmm::FilterCounts counts;
    counts.used = 10;
    hgmm::mrpt_bridge::warnOfPoints(counts, {});
    EXPECT_EQ(::testing::internal::GetCapturedStderr(), "");
    counts.doublings = 2;
    ::testing::internal::CaptureStderr();
    hgmm::mrpt_bridge::warnOfPoints(counts, {});
    EXPECT_EQ(::testing::internal::GetCapturedStderr(),
              "[hgmm] warning: a scan has more than 262144 samples at resolution_m = 0.04 "
              "[m]: it is read at 0.16 [m]\n");
}

TEST(ClearedRaysOfMaps, BadOptionsAreRefused) {
    CHGMMOccupancyMap map;
    map.insertionOptions.reading.clearedShareOfRange = 1.5;
    EXPECT_THROW(map.insertObservation(*observations::laser()), std::invalid_argument);
}

}  // namespace
