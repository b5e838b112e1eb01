#include <gtest/gtest.h>

#include <iostream>

#include "planted_mixture.h"
#include "scenes.h"

namespace hgmm {
namespace {

using namespace testing;
using test::uniform;

/// What a map says of points: shares of them that are more likely than not.
struct MeanShares {
    double occupied = 0, free = 0;
};

MeanShares sharesOf(const Map& map, const std::vector<Eigen::Vector3d>& points) {
    MeanShares shares;
    for (const Eigen::Vector3d& p : points) {
        const Occupancy o = map.occupancy(p);
        shares.occupied += (o.occupied > 0.5F) / double(points.size());
        shares.free += (o.free > 0.5F) / double(points.size());
    }
    return shares;
}

/// Points on the sides of a box that stands on the floor, `inset` from its edges.
std::vector<Eigen::Vector3d> sidesOf(const Box& box, double inset = 0.1) {
    std::vector<Eigen::Vector3d> points;
    const Eigen::Vector3d low = box.min().array() + inset, high = box.max().array() - inset;
    for (double s = 0; s <= 1; s += 0.1)
        for (double t = 0; t <= 1; t += 0.1) {
            const double z = low.z() + t * (high.z() - low.z());
            const double x = low.x() + s * (high.x() - low.x());
            const double y = low.y() + s * (high.y() - low.y());
            for (const double side : {box.min().x(), box.max().x()})
                points.emplace_back(side, y, z);
            for (const double side : {box.min().y(), box.max().y()})
                points.emplace_back(x, side, z);
        }
    return points;
}

/// Points of the volume of a box, `inset` from its sides.
std::vector<Eigen::Vector3d> volumeOf(const Box& box, double inset) {
    std::mt19937_64 engine(1);
    std::vector<Eigen::Vector3d> points;
    for (int i = 0; i < 500; ++i) {
        Eigen::Vector3d p;
        for (int d = 0; d < 3; ++d)
            p[d] = uniform(engine, box.min()[d] + inset, box.max()[d] - inset);
        points.push_back(p);
    }
    return points;
}

TEST(OccupancyChanges, ARemovedBoxIsFreeWithinTenScans) {
    for (const double edge : {0.5, 1.0}) {
        const Eigen::Vector3d low(2.0 - edge / 2, -edge / 2, 0.2);
        const Box box{low, low + Eigen::Vector3d(edge, edge, edge)};
        Map map = mapOf(roomWith(box), 20);
        EXPECT_GT(sharesOf(map, sidesOf(box)).occupied, 0.7);
        std::vector<Eigen::Vector3d> shadow;
        for (double y = -edge / 4; y <= edge / 4; y += edge / 20)
            for (double z = 0.6; z <= 0.9; z += 0.05) shadow.emplace_back(4.0, y, z);
        const auto inside = volumeOf(box, -0.05);
        int scans = 0;
        MeanShares place = sharesOf(map, inside);
        while (scans < 30 && place.free < 0.95) {
            map.insert(emptyRoom().scan(walk(20 + scans), 300 + scans));
            place = sharesOf(map, inside);
            ++scans;
        }
        std::cout << "box of " << edge << " m removed: place " << 100 * place.free
                  << " % free after " << scans << " scans\n";
        EXPECT_LE(scans, 10);
        for (int k = scans; k < 10; ++k)
            map.insert(emptyRoom().scan(walk(20 + k), 300 + k));
        EXPECT_GT(sharesOf(map, shadow).occupied, 0.95);
        EXPECT_LT(sharesOf(map, inside).occupied, 0.01);
    }
}

TEST(OccupancyChanges, ADoorThatMovesIsFollowedWithinTenScans) {
    const Box shut{Eigen::Vector3d(2.0, -0.5, 0.0), Eigen::Vector3d(2.05, 0.5, 2.0)};
    const Box open{Eigen::Vector3d(2.0, 0.5, 0.0), Eigen::Vector3d(3.0, 0.55, 2.0)};
    Map map = mapOf(roomWith(shut), 20);
    // Sides that face the walk.
    std::vector<Eigen::Vector3d> before, after;
    for (double s = 0.15; s <= 0.85; s += 0.05)
        for (double z = 0.3; z <= 1.7; z += 0.1) {
            before.emplace_back(2.0, s - 0.5, z);
            after.emplace_back(2.0 + s, 0.5, z);
        }
    EXPECT_GT(sharesOf(map, before).occupied, 0.9);
    int scans = 0;
    while (scans < 30 &&
           (sharesOf(map, before).free < 0.95 || sharesOf(map, after).occupied < 0.9)) {
        map.insert(roomWith(open).scan(walk(20 + scans), 400 + scans));
        ++scans;
    }
    std::cout << "door: old place " << 100 * sharesOf(map, before).free
              << " % free, new place " << 100 * sharesOf(map, after).occupied
              << " % occupied after " << scans << " scans\n";
    EXPECT_LE(scans, 10);
}

TEST(OccupancyChanges, SomethingNewInLongKnownFreeSpaceIsBelieved) {
    const Box box{Eigen::Vector3d(1.7, -0.3, 0.2), Eigen::Vector3d(2.3, 0.3, 1.2)};
    Map map = mapOf(emptyRoom(), 40);
    std::vector<Eigen::Vector3d> face;
    for (double y = -0.2; y <= 0.2; y += 0.04)
        for (double z = 0.4; z <= 1.1; z += 0.05) face.emplace_back(1.7, y, z);
    EXPECT_GT(sharesOf(map, face).free, 0.99);
    int scans = 0;
    while (scans < 30 && sharesOf(map, face).occupied < 0.95) {
        map.insert(roomWith(box).scan(walk(40 + scans, 0.8), 500 + scans));
        ++scans;
    }
    std::cout << "new box: " << 100 * sharesOf(map, face).occupied << " % occupied after "
              << scans << " scans\n";
    EXPECT_LE(scans, 10);
}

TEST(OccupancyChanges, AStaticRoomLosesNothingUnderPoseNoise) {
    const RoomScanner scanner;
    Map map;
    std::size_t removed = 0, contradicted = 0;
    for (int k = 0; k < 100; ++k) {
        const Pose truth = walk(k % 20, 0.8);
        Scan scan = scanner.scan(truth, 600 + k);
        scan.T_map_sensor = shaken(truth, 0.01, 0.2 * M_PI / 180, 700 + k);
        const InsertReport report = map.insert(scan);
        removed += report.componentsRemoved;
        contradicted += report.componentsCarved;
    }
    // The walls as a scan sees them.
    const Scan probe = scanner.scan(poseAt(0.3, 0.2, 1.2), 1);
    std::vector<Eigen::Vector3d> hits;
    for (std::size_t i = 0; i < probe.size(); i += 5) {
        const Eigen::Vector3d p(probe.x[i], probe.y[i], probe.z[i]);
        const Eigen::Vector3d u = p.normalized();
        hits.push_back(probe.T_map_sensor.t + scanner.range(probe.T_map_sensor.t, u) * u);
    }
    const MeanShares surfaces = sharesOf(map, hits);
    std::cout << "static room, 100 shaken scans: " << map.mixture().size()
              << " components, " << contradicted << " contradictions, " << removed
              << " removed; " << 100 * surfaces.occupied << " % of surfaces occupied, "
              << 100 * surfaces.free << " % free\n";
    EXPECT_GT(surfaces.occupied, 0.95);
    EXPECT_LT(surfaces.free, 0.04);
    EXPECT_GT(map.mixture().totalSupport(), 0.95 * 100 * 360 * 32);
}

}  // namespace
}  // namespace hgmm
