#include <gtest/gtest.h>
#include <mrpt/maps/CHGMMOccupancyMap.h>
#include <mrpt/maps/COctoMap.h>

#include <cmath>
#include <limits>

#include "lit_room.h"

using mrpt::maps::CHGMMOccupancyMap;
using mrpt::math::TPoint3D;

namespace {

const CHGMMOccupancyMap& scannedRoom() {
    static const CHGMMOccupancyMap map = lit_room::map();
    return map;
}

TPoint3D middle() {
    return {lit_room::kMiddle_map.x(), lit_room::kMiddle_map.y(),
            lit_room::kMiddle_map.z()};
}

/// A point given from the middle of the room.
double occupancyAt(double x, double y, double z, bool& known) {
    const TPoint3D p = middle() + TPoint3D(x, y, z);
    double probability = -1;
    known =
        scannedRoom().getPointOccupancy(float(p.x), float(p.y), float(p.z), probability);
    return probability;
}

TEST(OccupancyQueries, WallIsOccupiedRoomFreeAndOutsideUnknown) {
    bool known = false;
    EXPECT_GT(occupancyAt(3.0, 0.3, 0.2, known), 0.5);
    EXPECT_TRUE(known);
    EXPECT_LT(occupancyAt(1.5, 0.7, 0.4, known), 0.5);
    EXPECT_TRUE(known);
    EXPECT_EQ(occupancyAt(5.0, 0.3, 0.2, known), 0.5);
    EXPECT_FALSE(known) << "behind the wall";
    EXPECT_EQ(occupancyAt(1e6, -1e6, 3, known), 0.5);
    EXPECT_FALSE(known);
}

TEST(OccupancyQueries, WithinTheMapIsWhereThereIsAnAnswer) {
    double ignored = 0;
    int within = 0;
    for (double x = -4; x < 4; x += 0.13) {
        const TPoint3D p = middle() + TPoint3D(x, 0.21 * x, 0.05 * x);
        const bool known =
            scannedRoom().isPointWithinOctoMap(float(p.x), float(p.y), float(p.z));
        EXPECT_EQ(known, scannedRoom().getPointOccupancy(float(p.x), float(p.y), float(p.z),
                                                         ignored));
        within += known ? 1 : 0;
    }
    EXPECT_GT(within, 2);
    EXPECT_LT(within, 58);
    const float nan = std::numeric_limits<float>::quiet_NaN();
    EXPECT_FALSE(scannedRoom().isPointWithinOctoMap(nan, 0, 0));
    EXPECT_FALSE(scannedRoom().getPointOccupancy(0, nan, 0, ignored));
    EXPECT_EQ(ignored, 0.5);
    EXPECT_FALSE(CHGMMOccupancyMap().isPointWithinOctoMap(0, 0, 0));
}

TEST(OccupancyQueries, RaysEndAtTheWall) {
    for (const TPoint3D& direction : {TPoint3D(1, 0.1, 0), TPoint3D(-7, 1, 0.5),
                                      TPoint3D(0.1, 1, 0.2), TPoint3D(0.02, -0.01, -0.1)}) {
        TPoint3D end(9, 9, 9);
        ASSERT_TRUE(scannedRoom().castRay(middle(), direction, end, true)) << direction;
        const Eigen::Vector3d hit(end.x, end.y, end.z);
        EXPECT_NEAR(lit_room::depthInside(hit), 0.0, 0.1) << direction;
        const TPoint3D went = end - middle();
        EXPECT_NEAR(went.x * direction.x + went.y * direction.y + went.z * direction.z,
                    went.norm() * direction.norm(), 1e-6 * went.norm() * direction.norm());
    }
}

TEST(OccupancyQueries, RaysThroughKnownSpaceNeedNoLeaveForTheUnknown) {
    TPoint3D end;
    EXPECT_TRUE(scannedRoom().castRay(middle(), {1, 0.1, 0}, end));
    EXPECT_NEAR(end.x - middle().x, 3.0, 0.1);
    // From outside, the wall is behind the unknown.
    const TPoint3D outside = middle() + TPoint3D(6, 0, 0), unchanged(1, 2, 3);
    end = unchanged;
    EXPECT_FALSE(scannedRoom().castRay(outside, {-1, 0, 0}, end));
    EXPECT_EQ(end, unchanged);
    EXPECT_TRUE(scannedRoom().castRay(outside, {-1, 0, 0}, end, true));
    EXPECT_NEAR(end.x - middle().x, 3.0, 0.15);
}

TEST(OccupancyQueries, RangeLimitIsMetresWhateverTheDirectionsLength) {
    TPoint3D end;
    EXPECT_FALSE(scannedRoom().castRay(middle(), {100, 0, 0}, end, true, 2.5));
    EXPECT_TRUE(scannedRoom().castRay(middle(), {0.001, 0, 0}, end, true, 3.5));
    EXPECT_TRUE(scannedRoom().castRay(middle(), {1, 0, 0}, end, true, 0.0)) << "no limit";
    EXPECT_FALSE(scannedRoom().castRay(middle() + TPoint3D(8, 0, 0), {1, 0, 0}, end, true))
        << "away from the room, and ends";
}

TEST(OccupancyQueries, BadRaysThrowAndEmptyMapsHitNothing) {
    TPoint3D end;
    const double nan = std::nan("");
    EXPECT_THROW(scannedRoom().castRay(middle(), {0, 0, 0}, end), std::invalid_argument);
    EXPECT_THROW(scannedRoom().castRay(middle(), {nan, 0, 0}, end), std::invalid_argument);
    EXPECT_THROW(scannedRoom().castRay({nan, 0, 0}, {1, 0, 0}, end), std::invalid_argument);
    EXPECT_FALSE(CHGMMOccupancyMap().castRay(middle(), {1, 0, 0}, end, true));
}

/// What a program written for COctoMap calls.
template <typename OctoMap>
bool callAll(const OctoMap& map) {
    double probability = 0;
    TPoint3D end;
    mrpt::opengl::COctoMapVoxels voxels;
    map.getAsOctoMapVoxels(voxels);
    return map.getPointOccupancy(1.F, 2.F, 3.F, probability) ||
           map.castRay({0, 0, 0}, {1, 0, 0}, end, false, -1.0);
}

TEST(OccupancyQueries, CodeForCOctoMapCompilesWithThisMap) {
    EXPECT_FALSE(callAll(mrpt::maps::COctoMap(0.1)));
    EXPECT_FALSE(callAll(CHGMMOccupancyMap()));
}

}  // namespace
