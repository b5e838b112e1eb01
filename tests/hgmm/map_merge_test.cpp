#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <stdexcept>

#include "hgmm/map.h"
#include "scenes.h"

using namespace hgmm;
using namespace hgmm::testing;

namespace {

/// Scans [from, to) of one walk through one room, as seen in a frame of which the room's is
/// at T_frame_room.
Map partOfWalk(int from, int to, const Pose& T_frame_room = {},
               const MapParams& params = {}) {
    const RoomScanner scanner;
    Map map(params);
    for (int k = from; k < to; ++k) {
        Scan scan = scanner.scan(walk(k), 100 + static_cast<std::uint64_t>(k));
        scan.T_map_sensor = T_frame_room * scan.T_map_sensor;
        map.insert(scan);
    }
    return map;
}

/// How far two maps agree about points on and before surfaces that neither has seen.
struct Agreement {
    double sameState = 0.0;          ///< share of points that both call the same
    double meanDifference = 0.0;     ///< of P(occ)
    double meanLogDensityGap = 0.0;  ///< of hits, a - b [nat]
};

Agreement agreement(const Map& a, const Map& b) {
    const Scan scan = RoomScanner().scan(walk(31), 999);
    Agreement result;
    std::size_t points = 0, hits = 0;
    for (std::size_t i = 0; i < scan.size(); i += 7) {
        const Eigen::Vector3d hit =
            scan.T_map_sensor.R * Eigen::Vector3d(scan.x[i], scan.y[i], scan.z[i]) +
            scan.T_map_sensor.t;
        const Eigen::Vector3d back = (scan.T_map_sensor.t - hit).normalized();
        for (const double before_m : {0.0, 0.1, 0.4, 1.0}) {
            const Occupancy x = a.occupancy(hit + before_m * back);
            const Occupancy y = b.occupancy(hit + before_m * back);
            const auto state = [](const Occupancy& o) {
                return o.occupied > 0.5 ? 1 : o.free > 0.5 ? 2 : 0;
            };
            result.sameState += state(x) == state(y);
            result.meanDifference += std::abs(x.occupied - y.occupied);
            ++points;
        }
        const double gap = a.logDensity(hit) - b.logDensity(hit);
        if (!std::isfinite(gap)) continue;
        result.meanLogDensityGap += gap;
        ++hits;
    }
    EXPECT_GT(hits, 1000U);
    result.sameState /= static_cast<double>(points);
    result.meanDifference /= static_cast<double>(points);
    result.meanLogDensityGap /= static_cast<double>(hits);
    return result;
}

void expectAgreement(const Map& a, const Map& b) {
    const Agreement agreed = agreement(a, b);
    std::printf(
        "same state %.4f, P(occ) differs by %.4f, log density by %.3f nat; %zu and "
        "%zu components\n",
        agreed.sameState, agreed.meanDifference, agreed.meanLogDensityGap,
        a.mixture().size(), b.mixture().size());
    EXPECT_GT(agreed.sameState, 0.98);
    EXPECT_LT(agreed.meanDifference, 0.04);
    EXPECT_NEAR(agreed.meanLogDensityGap, 0.0, 0.1);
}

/// A door that one map saw open, and another one shut: what was hit stays.
TEST(MapMerge, KeepsADoorThatTheOtherMapSawShut) {
    const Box leftOfDoor{Eigen::Vector3d(2.0, -3.0, 0.0), Eigen::Vector3d(2.1, -0.5, 2.2)};
    const Box rightOfDoor{Eigen::Vector3d(2.0, 0.5, 0.0), Eigen::Vector3d(2.1, 3.0, 2.2)};
    const Box shut{Eigen::Vector3d(2.0, -3.0, 0.0), Eigen::Vector3d(2.1, 3.0, 2.2)};
    RoomScanner open = roomWith(leftOfDoor);
    open.furniture.push_back(rightOfDoor);
    std::vector<Eigen::Vector3d> door;
    for (double y = -0.3; y <= 0.3; y += 0.05)
        for (double z = 0.4; z <= 1.6; z += 0.1) door.emplace_back(2.0, y, z);
    const auto occupiedShare = [&](const Map& map) {
        double occupied = 0;
        for (const Eigen::Vector3d& p : door) occupied += map.occupancy(p).occupied > 0.5F;
        return occupied / double(door.size());
    };
    const Map closed = mapOf(roomWith(shut), 15);
    Map opened = closed;
    for (int k = 0; k < 6; ++k)
        opened.insert(open.scan(walk(15 + k), 500 + static_cast<std::uint64_t>(k)));
    EXPECT_GT(occupiedShare(closed), 0.9);
    EXPECT_LT(occupiedShare(opened), 0.2);
    Map either = opened, other = closed;
    either.merge(closed);
    other.merge(opened);
    EXPECT_GT(occupiedShare(either), 0.9);
    EXPECT_GT(occupiedShare(other), 0.9);
}

}  // namespace

TEST(MapMerge, PartsOfAWalkAnswerAsTheWholeDoes) {
    const Map whole = partOfWalk(0, 16);
    Map merged = partOfWalk(0, 8);
    merged.merge(partOfWalk(8, 16));
    expectAgreement(merged, whole);
    EXPECT_NEAR(merged.mixture().totalSupport(), whole.mixture().totalSupport(),
                0.02 * whole.mixture().totalSupport());
    EXPECT_LT(merged.mixture().size(), 2 * whole.mixture().size());
}

TEST(MapMerge, IsAssociativeWithinTheSameTolerance) {
    const Map a = partOfWalk(0, 5), b = partOfWalk(5, 10), c = partOfWalk(10, 15);
    Map left = a;
    left.merge(b);
    left.merge(c);
    Map right = b;
    right.merge(c);
    Map aFirst = a;
    aFirst.merge(right);
    expectAgreement(left, aFirst);
    Map reversed = c;
    reversed.merge(b);
    reversed.merge(a);
    expectAgreement(left, reversed);
}

TEST(MapMerge, FindsTheOtherMapsPlace) {
    // Turned about all axes, and 100 km away.
    Pose T_room_frame = poseAt(1.0e5, -2.0e5, 30.0, 0.8);
    T_room_frame.R =
        T_room_frame.R *
        Eigen::AngleAxisd(0.3, Eigen::Vector3d(1, 2, 0).normalized()).toRotationMatrix();
    Map merged = partOfWalk(0, 8);
    merged.merge(partOfWalk(8, 16, T_room_frame.inverse()), T_room_frame);
    expectAgreement(merged, partOfWalk(0, 16));
}

TEST(MapMerge, AnEmptyMapBecomesTheOther) {
    const Map other = partOfWalk(0, 4);
    Map map;
    map.merge(other);
    EXPECT_TRUE(map == other);
    map.merge(Map());
    EXPECT_TRUE(map == other);
}

TEST(MapMerge, AMapMergedWithItselfIsTwiceAsSure) {
    Map map = partOfWalk(0, 4);
    const Map before = map;
    map.merge(map);
    ASSERT_EQ(map.mixture().size(), before.mixture().size());
    for (std::size_t i = 0; i < before.mixture().size(); ++i) {
        EXPECT_FLOAT_EQ(map.mixture().support[i], 2 * before.mixture().support[i]);
        EXPECT_NEAR(map.mixture().mean[0][i], before.mixture().mean[0][i], 1e-5);
    }
    EXPECT_EQ(map.freeMixture().size(), before.freeMixture().size());
    map.mixture().check();
    map.freeMixture().check();
}

TEST(MapMerge, WhatItDerivesIsThatOfALoadedMap) {
    Map merged = partOfWalk(0, 4);
    merged.merge(partOfWalk(4, 8), poseAt(0.02, 0.0, 0.0, 0.01));
    const auto bytes = merged.save(Encoding::exact);
    const Map loaded = Map::load(bytes.data(), bytes.size());
    ASSERT_TRUE(loaded == merged);
    for (double x = -4.5; x < 4.5; x += 0.37)
        for (double y = -3.5; y < 3.5; y += 0.41) {
            const Occupancy a = merged.occupancy({x, y, 1.0});
            const Occupancy b = loaded.occupancy({x, y, 1.0});
            EXPECT_EQ(a.occupied, b.occupied);
            EXPECT_EQ(a.unknown, b.unknown);
        }
    EXPECT_EQ(merged.mixture(2).size(), loaded.mixture(2).size());
}

TEST(MapMerge, BadInputChangesNothing) {
    Map map = partOfWalk(0, 2);
    const Map before = map;
    Pose skewed;
    skewed.R(0, 0) = 2.0;
    Pose unknown;
    unknown.t.x() = std::numeric_limits<double>::quiet_NaN();
    const Map other = partOfWalk(2, 4);
    EXPECT_THROW(map.merge(other, skewed), std::invalid_argument);
    EXPECT_THROW(map.merge(other, unknown), std::invalid_argument);
    EXPECT_TRUE(map == before);
}
