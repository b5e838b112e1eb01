#include <gtest/gtest.h>

#include <cmath>

#include "hgmm/map.h"
#include "hgmm/params.h"

namespace hgmm {
namespace {

/// A planar laser of 360 rays at the origin that sees nothing within 8 m, but for a post at
/// x = 3 m if there is one.
Scan laserScan(bool hasPost, float cleared_m = 8.F) {
    Scan scan;
    for (int i = 0; i < 360; ++i) {
        const double a = (i - 180) * M_PI / 180;
        const Eigen::Vector3d u(std::cos(a), std::sin(a), 0);
        if (hasPost && std::abs(a) < 0.1) {
            const Eigen::Vector3f p = (2.9 * u).cast<float>();
            scan.pushBack(p.x(), p.y(), p.z());
        } else {
            scan.clearedRays.push_back({u.cast<float>(), cleared_m});
        }
    }
    return scan;
}

TEST(ClearedSpace, RaysWithoutAnyHitMakeItFree) {
    Map map;
    map.insert(laserScan(false));
    EXPECT_TRUE(map.empty());
    for (double a = 0; a < 6.28; a += 0.1)
        for (const double r : {0.5, 2.0, 5.0, 7.5}) {
            const Occupancy o = map.occupancy({r * std::cos(a), r * std::sin(a), 0});
            EXPECT_GT(o.free, 0.5F) << r << " m";
            EXPECT_EQ(o.occupied, 0.F) << r << " m";
        }
    for (const double r : {8.6, 12.0})  // nothing is marked at their end
        EXPECT_EQ(map.occupancy({r, 0, 0}).unknown, 1.F) << r << " m";
    EXPECT_EQ(map.occupancy({3, 0, 1}).unknown, 1.F);
    EXPECT_FALSE(map.castRay({0, 0, 0}, {1, 0.2, 0}));
}

TEST(ClearedSpace, RaysWithoutAHitRemoveWhatIsGone) {
    Map map;
    for (int k = 0; k < 50; ++k) map.insert(laserScan(true));
    EXPECT_GT(map.occupancy({2.9, 0, 0}).occupied, 0.5F);
    EXPECT_LT(map.occupancy({3.5, 0, 0}).free, 0.5F);
    for (int k = 0; k < 3; ++k) map.insert(laserScan(false));
    EXPECT_GT(map.occupancy({2.9, 0, 0}).free, 0.5F);
    EXPECT_GT(map.occupancy({3.5, 0, 0}).free, 0.5F);
}

TEST(ClearedSpace, ALimitOfRangeCutsRays) {
    MapParams params;
    params.filter.maxRange_m = 5.0;
    Map map(params);
    Scan wall;
    for (double y = -6; y <= 6; y += 0.05)
        for (double z = -1; z <= 1; z += 0.1)
            wall.pushBack(8.F, static_cast<float>(y), static_cast<float>(z));
    map.insert(wall);
    for (const double x : {1.0, 3.0, 4.5})
        EXPECT_GT(map.occupancy({x, 0, 0}).free, 0.5F) << x;
    for (const double x : {6.0, 8.0}) EXPECT_EQ(map.occupancy({x, 0, 0}).unknown, 1.F) << x;
}

TEST(ClearedSpace, SurvivesSavingCopyingAndMerging) {
    Map map;
    map.insert(laserScan(false));
    const auto bytes = map.save(Encoding::exact);
    const Map loaded = Map::load(bytes.data(), bytes.size());
    EXPECT_TRUE(loaded == map);
    const auto compact = map.save();
    const Map small = Map::load(compact.data(), compact.size());
    EXPECT_EQ(small.save(), compact);
    Map merged;
    Pose aside;
    aside.t = {1, 2, 0};
    merged.merge(map, aside);
    for (const Map* m : {&loaded, &small}) EXPECT_GT(m->occupancy({4, 1, 0}).free, 0.5F);
    EXPECT_GT(merged.occupancy({5, 3, 0}).free, 0.5F);
    EXPECT_GT(map.coverageBytes(0), map.coverageBytes(2));
    EXPECT_GT(map.occupancy({4, 1, 0}, 1).free, 0.5F);
}

}  // namespace
}  // namespace hgmm
