#include "hgmm/evaluation/room_figures.h"

#include <gtest/gtest.h>
#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <stdexcept>

using namespace hgmm::evaluation;

namespace {

const Box kRoom{{-3, -2, 0}, {5, 4, 2.5}};

/// Exact rays from one place to all walls.
std::vector<Ray> raysToWalls(std::size_t n,
                             const Eigen::Vector3d& origin = {0.5, 0.5, 1.2}) {
    std::vector<Ray> rays;
    for (std::size_t i = 0; i < n; ++i) {
        const double z = 1.0 - 2.0 * (double(i) + 0.5) / double(n);
        const double angle = 0.3 + 2.399963229728653 * double(i), r = std::sqrt(1 - z * z);
        const Eigen::Vector3d u(r * std::cos(angle), r * std::sin(angle), z);
        double range = 1e9;
        for (int d = 0; d < 3; ++d)
            range = std::min(
                range, ((u[d] > 0 ? kRoom.high[d] : kRoom.low[d]) - origin[d]) / u[d]);
        rays.push_back({origin, origin + range * u});
    }
    return rays;
}

hgmm::Map mapOf(const std::vector<Ray>& rays) {
    hgmm::Scan scan;
    scan.T_map_sensor.t = rays.front().origin_map;
    for (const Ray& ray : rays) {
        const Eigen::Vector3f p = (ray.hit_map - ray.origin_map).cast<float>();
        scan.pushBack(p.x(), p.y(), p.z());
    }
    hgmm::Map map;
    map.insert(scan);
    return map;
}

}  // namespace

TEST(RoomFigures, RoomIsTheBoxAroundItsWalls) {
    const Box room = roomOf(raysToWalls(5000));
    EXPECT_LT((room.low - kRoom.low).norm(), 1e-6);
    EXPECT_LT((room.high - kRoom.high).norm(), 1e-6);
}

TEST(RoomFigures, WhatIsNoEmptyBoxRoomIsRefused) {
    std::vector<Ray> furnished = raysToWalls(1000);
    for (std::size_t i = 0; i < 10; ++i)
        furnished[100 * i].hit_map =
            0.5 * (furnished[100 * i].hit_map + furnished[100 * i].origin_map);
    EXPECT_THROW(roomOf(furnished), std::invalid_argument);
    std::vector<Ray> turned = raysToWalls(1000);
    for (Ray& ray : turned)
        ray.hit_map = Eigen::AngleAxisd(0.2, Eigen::Vector3d::UnitZ()) * ray.hit_map;
    EXPECT_THROW(roomOf(turned), std::invalid_argument);
    std::vector<Ray> outside = raysToWalls(1000);
    outside.back().origin_map.x() = 6;
    EXPECT_THROW(roomOf(outside), std::invalid_argument);
    EXPECT_THROW(roomOf({}), std::invalid_argument);
}

// A map that knows nothing is right about what is hidden, and about nothing else: free
// points are not occupied, but unknown.
TEST(RoomFigures, EmptyMapKnowsNothing) {
    const RoomFigures f = evaluateRoom(hgmm::Map(), raysToWalls(500), kRoom, 1);
    EXPECT_EQ(f.wallPoints, 500U);
    EXPECT_EQ(f.hiddenPoints, 500U);
    EXPECT_GT(f.freePoints, 1200U);
    EXPECT_LT(f.freePoints, 1500U) << "some are within 10 cm of a wall";
    EXPECT_EQ(f.wallOccupied, 0.0);
    EXPECT_EQ(f.freeNotOccupied, 1.0);
    EXPECT_EQ(f.freeUnknown, 1.0);
    EXPECT_EQ(f.hiddenUnknown, 1.0);
    EXPECT_THROW(evaluateRoom(hgmm::Map(), {}, kRoom, 1), std::invalid_argument);
}

TEST(RoomFigures, MapOfTheRoomIsRightAndOfAnotherRoomIsNot) {
    const hgmm::Map map = mapOf(raysToWalls(20000));
    const RoomFigures f = evaluateRoom(map, raysToWalls(3000, {1.0, 0.8, 1.0}), kRoom, 1);
    EXPECT_GT(f.wallOccupied, 0.95);
    EXPECT_GT(f.freeNotOccupied, 0.99);
    EXPECT_LT(f.freeUnknown, 0.05);
    EXPECT_GT(f.hiddenUnknown, 0.95);

    // The same questions, half a metre aside: three walls are asked for where there is free
    // space.
    std::vector<Ray> moved = raysToWalls(3000, {1.0, 0.8, 1.0});
    for (Ray& ray : moved) ray.hit_map.array() -= 0.5, ray.origin_map.array() -= 0.5;
    const Box movedRoom{kRoom.low.array() - 0.5, kRoom.high.array() - 0.5};
    const RoomFigures wrong = evaluateRoom(map, moved, movedRoom, 1);
    EXPECT_LT(wrong.wallOccupied, 0.2);
    EXPECT_LT(wrong.hiddenUnknown, f.hiddenUnknown);
}
