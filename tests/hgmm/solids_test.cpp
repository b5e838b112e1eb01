#include <gtest/gtest.h>

#include "planted_mixture.h"
#include "scenes.h"

namespace hgmm {
namespace {

using namespace testing;
using test::uniform;

constexpr double kSkin_m = 0.04;  ///< so near to a face nothing is asked

/// Share of the points inside a box that are free.
double freeInside(const Map& map, const Box& box, double height_m = -1) {
    std::mt19937_64 engine(1);
    int free = 0;
    constexpr int kPoints = 2000;
    for (int i = 0; i < kPoints; ++i) {
        Eigen::Vector3d p;
        for (int d = 0; d < 3; ++d)
            p[d] = uniform(engine, box.min()[d] + kSkin_m, box.max()[d] - kSkin_m);
        if (height_m >= 0) p.z() = height_m;
        free += map.occupancy(p).free > 0.5F;
    }
    return double(free) / kPoints;
}

Box solid(double edge) {
    return {Eigen::Vector3d(2.0 - edge / 2, 1.0 - edge / 2, 0.0),
            Eigen::Vector3d(2.0 + edge / 2, 1.0 + edge / 2, 1.7)};
}

/// Poses all round a solid, 1.2 m to 2 m from its middle.
Pose round(int k) {
    const double a = 0.9 * k, r = 1.2 + 0.2 * (k % 5);
    return poseAt(2.0 + r * std::cos(a), 1.0 + 0.85 * r * std::sin(a), 0.7 + 0.1 * (k % 3),
                  a);
}

TEST(Solids, AreHardlyFreeInside) {
    for (const double edge : {0.2, 0.5, 1.2}) {
        const RoomScanner scanner = roomWith(solid(edge));
        for (const int scans : {9, 40}) {
            Map map;
            for (int k = 0; k < scans; ++k)
                map.insert(scanner.scan(round(k), 10 + static_cast<std::uint64_t>(k)));
            EXPECT_LE(freeInside(map, solid(edge)), edge < 0.3 ? 0.15 : 0.03)
                << edge << " m, " << scans << " scans";
        }
    }
}

TEST(Solids, AreNotFreeInsideForAPlanarLaser) {
    for (const double edge : {0.2, 0.5, 1.2}) {
        RoomScanner scanner = roomWith(solid(edge));
        scanner.elevations = 1;
        scanner.azimuths = 720;
        Map map;
        for (int k = 0; k < 30; ++k) {
            Pose pose = round(k);
            pose.t.z() = 0.5;
            map.insert(scanner.scan(pose, 10 + static_cast<std::uint64_t>(k)));
        }
        EXPECT_LE(freeInside(map, solid(edge), 0.5), 0.001) << edge << " m";
        // All round it is free, but for tails of its sides.
        int free = 0, points = 0;
        for (double a = 0; a < 6.28; a += 0.05, ++points) {
            const double r = 0.75 * edge + 0.15;
            free +=
                map.occupancy({2.0 + r * std::cos(a), 1.0 + r * std::sin(a), 0.5}).free >
                0.5F;
        }
        EXPECT_GT(free, 0.95 * points) << edge << " m";
    }
}

TEST(Solids, SpaceUnderATableTopIsFree) {
    const Box top{Eigen::Vector3d(1.2, 0.4, 0.72), Eigen::Vector3d(2.4, 1.4, 0.75)};
    const RoomScanner scanner = roomWith(top);
    Map map;
    for (int k = 0; k < 30; ++k) {
        Pose pose = round(k);
        pose.t.z() = k % 2 == 0 ? 0.4 : 1.2;
        map.insert(scanner.scan(pose, 10 + static_cast<std::uint64_t>(k)));
    }
    int free = 0, occupied = 0, points = 0;
    for (double x = 1.35; x < 2.3; x += 0.05)
        for (double y = 0.55; y < 1.3; y += 0.05) {
            ++points;
            free += map.occupancy({x, y, 0.64}).free > 0.5F;
            occupied += map.occupancy({x, y, 0.745}).occupied > 0.5F;
        }
    EXPECT_GT(free, 0.97 * points);
    EXPECT_GT(occupied, 0.95 * points);
}

}  // namespace
}  // namespace hgmm
