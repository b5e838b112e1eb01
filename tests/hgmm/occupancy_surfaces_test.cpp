#include <gtest/gtest.h>

#include <iostream>
#include <limits>

#include "planted_mixture.h"
#include "scenes.h"

namespace hgmm {
namespace {

using namespace testing;
using test::uniform;

struct Shares {
    int all = 0, occupied = 0, free = 0, unknown = 0;
    void add(const Occupancy& o) {
        ++all;
        occupied += o.occupied > 0.5F;
        free += o.free > 0.5F;
        unknown += o.unknown > 0.5F;
    }
    double share(int n) const { return double(n) / all; }
};

TEST(OccupancyOfAWall, OccupiedOnItFreeBeforeUnknownBehind) {
    const Map map = mapOf(emptyRoom(), 8);
    std::mt19937_64 engine(1);
    Shares on, ten, metre, behind;
    double worstDistance = 0;
    for (int i = 0; i < 2000; ++i) {
        const double y = uniform(engine, -2.5, 2.5), z = uniform(engine, 0.4, 2.1);
        on.add(map.occupancy({4, y, z}));
        ten.add(map.occupancy({3.9, y, z}));
        metre.add(map.occupancy({3, y, z}));
        behind.add(map.occupancy({4.5, y, z}));
        EXPECT_LT(map.occupancy({3.9, y, z}).occupied, 0.5F);
        EXPECT_GT(map.occupancy({4, y, z}).variance_m2, 0);
        const Occupancy before = map.occupancy({3.7, y, z});
        EXPECT_GT(before.variance_m2, 0);
        worstDistance = std::max(worstDistance, std::abs(before.alongRay_m - 0.3));
    }
    std::cout << "wall: " << 100 * on.share(on.occupied) << " % occupied on it, "
              << 100 * ten.share(ten.free) << " % free 10 cm before, "
              << 100 * behind.share(behind.unknown) << " % unknown 0.5 m behind; distance "
              << "0.3 m off by up to " << worstDistance << " m\n";
    EXPECT_GT(on.share(on.occupied), 0.97);
    EXPECT_GT(ten.share(ten.free), 0.99);
    EXPECT_GT(metre.share(metre.free), 0.99);
    EXPECT_EQ(behind.unknown, behind.all);
    // Along rays that meet the wall aslant, it is a little more.
    EXPECT_LT(worstDistance, 0.25);
}

TEST(OccupancyOfAWall, ThinBoardsHaveTwoSides) {
    const Box board{Eigen::Vector3d(-0.01, -1.5, 0), Eigen::Vector3d(0.01, 1.5, 2.5)};
    RoomScanner scanner = roomWith(board);
    Map map;
    for (int k = 0; k < 12; ++k) {
        const double side = k % 2 == 0 ? 1 : -1;
        map.insert(scanner.scan(
            poseAt(side * (1.5 + 0.1 * (k % 3)), 0.3 * (k % 5) - 0.6, 1.2, 0.2 * k),
            200 + k));
    }
    std::mt19937_64 engine(2);
    Shares within, right, left;
    for (int i = 0; i < 1000; ++i) {
        const double y = uniform(engine, -1.2, 1.2), z = uniform(engine, 0.6, 1.8);
        within.add(map.occupancy({0, y, z}));
        right.add(map.occupancy({0.15, y, z}));
        left.add(map.occupancy({-0.15, y, z}));
    }
    std::cout << "board of 2 cm: " << 100 * within.share(within.occupied)
              << " % occupied within, " << 100 * right.share(right.free) << " and "
              << 100 * left.share(left.free) << " % free 15 cm to its sides\n";
    EXPECT_GT(within.share(within.occupied), 0.95);
    EXPECT_GT(right.share(right.free), 0.97);
    EXPECT_GT(left.share(left.free), 0.97);
}

/// Distance of a point from the nearest wall of the empty room [m].
double offWall(const RoomScanner& scanner, const Eigen::Vector3d& p) {
    const Eigen::Vector3d low = (p - scanner.room.min()).cwiseAbs();
    const Eigen::Vector3d high = (p - scanner.room.max()).cwiseAbs();
    return std::min(low.minCoeff(), high.minCoeff());
}

TEST(CastRay, MeetsTheWallWithinThreeCentimetresOnAllLevels) {
    const RoomScanner scanner = emptyRoom();
    const Map map = mapOf(scanner, 8);
    const Eigen::Vector3d origin(0.2, 0.3, 1.2);
    std::mt19937_64 engine(3);
    for (std::size_t level = 0; level < map.levelCount(); ++level) {
        int hits = 0, close = 0, all = 0;
        double bias = 0;
        for (int i = 0; i < 1000; ++i) {
            const double azimuth = uniform(engine, -M_PI, M_PI);
            const double elevation = uniform(engine, -0.4, 0.4);
            const Eigen::Vector3d u(std::cos(elevation) * std::cos(azimuth),
                                    std::cos(elevation) * std::sin(azimuth),
                                    std::sin(elevation));
            const double expected = scanner.range(origin, u);
            const auto hit = map.castRay(origin, uniform(engine, 0.1, 10) * u, {}, level);
            ++all;
            if (!hit) continue;
            ++hits;
            // Off the wall, not along the ray: P(occ) rises some sigma before the surface,
            // which a grazing ray meets far from where it ends.
            close += offWall(scanner, hit->point_map) < 0.03;
            bias += (hit->range_m - expected) / 1000;
            EXPECT_TRUE(hit->point_map.isApprox(origin + hit->range_m * u, 1e-9));
            EXPECT_GE(map.occupancy(hit->point_map, level).occupied, 0.499F);
        }
        std::cout << "castRay, level " << level << ": " << close << " of " << all
                  << " within 3 cm, " << all - hits << " without a hit, range off by "
                  << bias << " m in the mean\n";
        EXPECT_GE(hits, level == 0 ? 990 : 900);
        if (level == 0) {
            EXPECT_GE(close, 970);
        }
    }
}

TEST(CastRay, RangeAndUnknownEndIt) {
    const Map map = mapOf(emptyRoom(), 8);
    const Eigen::Vector3d inside(0, 0, 1.2), outside(9, 0, 1.2);
    RayCastParams params;
    EXPECT_TRUE(map.castRay(inside, {1, 0, 0}, params));
    params.maxRange_m = 3;
    EXPECT_FALSE(map.castRay(inside, {1, 0, 0}, params));
    params = {};
    params.stopAtUnknown = true;
    EXPECT_TRUE(map.castRay(inside, {1, 0, 0}, params));
    EXPECT_FALSE(map.castRay(outside, {-1, 0, 0}, params));
    params.stopAtUnknown = false;
    const auto hit = map.castRay(outside, {-1, 0, 0}, params);
    ASSERT_TRUE(hit);
    EXPECT_NEAR(hit->range_m, 5, 0.1);
    EXPECT_FALSE(map.castRay(outside, {1, 0, 0}, params));
}

TEST(CastRay, RefusesBadArguments) {
    const Map map = mapOf(emptyRoom(), 1);
    const double nan = std::nan(""), inf = std::numeric_limits<double>::infinity();
    const Eigen::Vector3d origin(0, 0, 1), x(1, 0, 0);
    for (const Eigen::Vector3d& bad :
         {Eigen::Vector3d(0, 0, 0), Eigen::Vector3d(nan, 0, 0), Eigen::Vector3d(inf, 0, 0)})
        EXPECT_THROW(map.castRay(origin, bad), std::invalid_argument);
    EXPECT_THROW(map.castRay({nan, 0, 0}, x), std::invalid_argument);
    for (const double range : {0.0, -1.0, nan, inf}) {
        RayCastParams params;
        params.maxRange_m = range;
        EXPECT_THROW(map.castRay(origin, x, params), std::invalid_argument);
    }
    for (const double occupied : {0.0, 1.0, -1.0, nan}) {
        RayCastParams params;
        params.minOccupied = occupied;
        EXPECT_THROW(map.castRay(origin, x, params), std::invalid_argument);
    }
    EXPECT_THROW(map.castRay(origin, x, {}, 5), std::out_of_range);
}

}  // namespace
}  // namespace hgmm
