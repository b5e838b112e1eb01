#include "hgmm/scan.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "hgmm/map.h"
#include "room_scanner.h"

namespace hgmm {
namespace {

using testing::poseAt;
using testing::RoomScanner;

TEST(ScanSamples, DoNotDependOnThePose) {
    Scan scan = RoomScanner().scan(poseAt(0.3, 0.1, 1.2, 0.7), 5);
    const ScanSamples here = samplesOf(scan, {});
    EXPECT_EQ(here.points.used, scan.size());
    scan.T_map_sensor = poseAt(900, -70, 3, 2);
    EXPECT_EQ(samplesOf(scan, {}).samples_sensor, here.samples_sensor);
    EXPECT_EQ(here.normalOfRays_sensor, Eigen::Vector3d::Zero().eval());

    Scan planar;
    for (int i = 0; i < 180; ++i) {
        const float angle = 0.0174533F * float(i);
        planar.pushBack(3 * std::cos(angle), 0.F, 3 * std::sin(angle));
    }
    planar.T_map_sensor = scan.T_map_sensor;
    EXPECT_GT(std::abs(samplesOf(planar, {}).normalOfRays_sensor.y()), 1 - 1e-9);
}

TEST(ScanSamples, MakeTheMapThatTheScanMakes) {
    Map whole, apart;
    for (int i = 0; i < 4; ++i) {
        // Far off: the local frame must begin at the same place.
        const Scan scan = RoomScanner().scan(poseAt(0.4 * i, 0.1 * i, 1.2, 0.3 * i), 5 + i);
        const Pose far{scan.T_map_sensor.R,
                       scan.T_map_sensor.t + Eigen::Vector3d(1e5, -3e4, 20)};
        Scan moved = scan;
        moved.T_map_sensor = far;
        const InsertReport a = whole.insert(moved);
        const InsertReport b = apart.insert(samplesOf(scan, apart.params()), far);
        EXPECT_EQ(a.points.used, b.points.used);
        EXPECT_EQ(a.samples, b.samples);
        EXPECT_EQ(a.componentsAdded, b.componentsAdded);
    }
    EXPECT_EQ(apart, whole);
    EXPECT_EQ(apart.origin(), whole.origin());
}

TEST(ScanSamples, BadInputIsRefusedAndLosesNothing) {
    Scan scan = RoomScanner().scan(poseAt(0, 0, 1.2), 5);
    Map map;
    const ScanSamples samples = samplesOf(scan, {});
    map.insert(samples, {});
    const Map before = map;
    Pose pose;
    pose.t.x() = std::numeric_limits<double>::quiet_NaN();
    EXPECT_THROW(map.insert(samples, pose), std::invalid_argument);
    pose = {};
    pose.R *= 2;
    EXPECT_THROW(map.insert(samples, pose), std::invalid_argument);
    EXPECT_EQ(map.insert(ScanSamples(), {}).samples, 0U);
    EXPECT_EQ(map, before);

    MapParams params;
    params.filter.resolution_m = -1;
    EXPECT_THROW(samplesOf(scan, params), std::invalid_argument);
    scan.y.pop_back();
    EXPECT_THROW(samplesOf(scan, {}), std::invalid_argument);
}

}  // namespace
}  // namespace hgmm
