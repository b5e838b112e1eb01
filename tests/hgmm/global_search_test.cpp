// A sensor that is looked for in a whole map.
#include "hgmm/global_search.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>

#include "room_scanner.h"

namespace hgmm {
namespace {

using testing::poseAt;
using testing::RoomScanner;

RoomScanner smallScanner() {
    RoomScanner scanner;
    scanner.azimuths = 120;
    scanner.elevations = 12;
    return scanner;
}

Map mapOf(const RoomScanner& scanner) {
    Map map;
    std::uint64_t seed = 1;
    for (const double x : {-2.0, 0.0, 2.0})
        map.insert(scanner.scan(poseAt(x, -0.5 + 0.2 * x, 1.0, x), seed++));
    return map;
}

TEST(GlobalSearch, FindsASensorOfWhichNothingIsKnown) {
    const RoomScanner scanner = smallScanner();
    const Map map = mapOf(scanner);
    for (const Pose& truth : {poseAt(-1.2, 0.9, 1.1, 2.0), poseAt(1.9, -1.1, 0.9, -1.1)}) {
        const auto found = findInMap(map, samplesOf(scanner.scan(truth, 9), map.params()));
        ASSERT_TRUE(found);
        EXPECT_LT((found->T_map_sensor.t - truth.t).norm(), 0.05);
        EXPECT_LT(
            Eigen::AngleAxisd(Eigen::Matrix3d(found->T_map_sensor.R * truth.R.transpose()))
                .angle(),
            0.02);
    }
}

TEST(GlobalSearch, RefusesPlacesThatLookAlike) {
    // A bare room is the same after half a turn.
    RoomScanner bare = smallScanner();
    bare.furniture.clear();
    const Map map = mapOf(bare);
    EXPECT_FALSE(
        findInMap(map, samplesOf(bare.scan(poseAt(1.9, -1.1, 0.9, 0.4), 9), map.params())));
}

TEST(GlobalSearch, RefusesAnotherBuilding) {
    const Map map = mapOf(smallScanner());
    RoomScanner elsewhere = smallScanner();
    elsewhere.room = {Eigen::Vector3d(-15, -12, -3), Eigen::Vector3d(15, 12, 9)};
    elsewhere.furniture.clear();
    EXPECT_FALSE(
        findInMap(map, samplesOf(elsewhere.scan(poseAt(0, 0, 1), 9), map.params())));
    EXPECT_FALSE(findInMap(Map(), samplesOf(elsewhere.scan(poseAt(0, 0, 1), 9), {})));
    EXPECT_FALSE(findInMap(map, samplesOf(Scan(), map.params())));
    GlobalSearchParams params;
    params.headings = 0;
    EXPECT_THROW(findInMap(map, ScanSamples(), params), std::invalid_argument);
}

}  // namespace
}  // namespace hgmm
