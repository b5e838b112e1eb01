#include "registration/grazing_samples.h"

#include <gtest/gtest.h>

#include <numeric>

#include "hgmm/scan.h"
#include "room_scanner.h"

namespace hgmm {
namespace {

using testing::poseAt;
using testing::RoomScanner;

/// A corridor of 2 m, with a floor 1 m below the sensor, which ends at x = +-12 m.
RoomScanner corridorOfSparseRings() {
    RoomScanner scanner;
    scanner.room = {Eigen::Vector3d(-12, -1, 0), Eigen::Vector3d(12, 1, 3)};
    scanner.furniture.clear();
    scanner.azimuths = 240;
    scanner.elevations = 16;
    scanner.elevationSpan_rad = 0.52;
    return scanner;
}

TEST(GrazingSamples, AreThoseOfFarWallsAndFloorsButNotOfTheEnd) {
    Scan scan = corridorOfSparseRings().scan(poseAt(0, 0, 1), 1);
    scan.T_map_sensor = Pose();
    const Mixture<3> samples = filterScan(scan, FilterParams());
    std::vector<std::size_t> all(samples.size());
    std::iota(all.begin(), all.end(), std::size_t{0});
    const std::vector<bool> grazing = areGrazing(samples, all);
    int far = 0, farGrazing = 0, facing = 0, facingGrazing = 0;
    for (const std::size_t i : all) {
        const double x = std::abs(double(samples.mean[0][i]));
        const double y = std::abs(double(samples.mean[1][i]));
        const bool isAtTheEnd = x > 11.9;
        if (!isAtTheEnd && x > 5 && x < 10) {
            ++far;
            farGrazing += grazing[i] ? 1 : 0;
        }
        if ((isAtTheEnd && y < 0.4) || x < 1) {
            ++facing;
            facingGrazing += grazing[i] ? 1 : 0;
        }
    }
    ASSERT_GT(far, 50);
    ASSERT_GT(facing, 50);
    EXPECT_GT(farGrazing, 0.6 * far);
    EXPECT_LT(facingGrazing, 0.05 * facing);
}

TEST(GrazingSamples, APoleBeforeAWallIsNone) {
    Scan scan;
    for (int k = -20; k <= 20; ++k) {
        const double azimuth = 0.0131 * k;
        const double range_m = std::abs(k) < 2 ? 4.0 : 8.0 / std::cos(azimuth);
        scan.pushBack(float(range_m * std::cos(azimuth)),
                      float(range_m * std::sin(azimuth)), 0.F);
    }
    const Mixture<3> samples = filterScan(scan, FilterParams());
    for (std::size_t i = 0; i < samples.size(); ++i)
        if (samples.mean[0][i] < 5.F) {
            EXPECT_FALSE(areGrazing(samples, {i})[0]);
        }
}

TEST(GrazingSamples, OfOneSampleOrNoneNothingIsKnown) {
    Scan scan;
    EXPECT_TRUE(areGrazing(filterScan(scan, FilterParams()), {}).empty());
    scan.pushBack(5.F, 0.F, 0.F);
    EXPECT_EQ(areGrazing(filterScan(scan, FilterParams()), {0}), std::vector<bool>{false});
}

}  // namespace
}  // namespace hgmm
