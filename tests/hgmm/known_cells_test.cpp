#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <array>
#include <cmath>
#include <limits>

#include "hgmm/map.h"

namespace {

using hgmm::KnownCells;
using hgmm::Map;

enum State { unknown, free_, occupied };

/// A room of 3 x 2.4 x 1.6 m with a table, a solid post and a thin screen. Nobody looked
/// behind its walls, above it or into the post.
State roomAt(double x, double y, double z, double edge) {
    if (x < 0 || y < 0 || z < 0 || x > 3 || y > 2.4 || z > 1.6) return unknown;
    if (x < edge || y < edge || z < edge || x > 3 - edge || y > 2.4 - edge) return occupied;
    const double fromPost = std::max(std::abs(x - 2.2), std::abs(y - 1.6));
    if (fromPost < 0.3) return fromPost > 0.3 - edge ? occupied : unknown;
    if (x > 0.5 && x < 1.2 && y > 0.6 && y < 1.6 && z > 0.7 && z < 0.7 + edge)
        return occupied;
    if (x > 1.6 && x < 1.6 + edge && y < 0.8) return occupied;
    return free_;
}

struct Room {
    KnownCells cells;
    std::vector<Eigen::Vector3d> centres_map;
    std::vector<State> states;
};

Room room(double edge, const hgmm::Pose& T_map_cells, double maxHeight = 1.8) {
    Room room;
    room.cells.edge_m = edge;
    room.cells.T_map_cells = T_map_cells;
    const auto end = [&](double m) { return static_cast<int>(std::lround(m / edge)); };
    for (int z = -2; z < end(maxHeight); ++z)
        for (int y = -2; y < end(2.6); ++y)
            for (int x = -2; x < end(3.2); ++x) {
                const Eigen::Vector3d centre((x + .5) * edge, (y + .5) * edge,
                                             (z + .5) * edge);
                const State state = roomAt(centre.x(), centre.y(), centre.z(), edge);
                if (state == occupied) room.cells.occupied.push_back({{x, y, z}, 1});
                if (state == free_) room.cells.free.push_back({{x, y, z}, 1});
                room.centres_map.push_back(T_map_cells.R * centre + T_map_cells.t);
                room.states.push_back(state);
            }
    return room;
}

struct Shares {
    double same = 0, opposite = 0;  ///< of the cells that were known
    double unknownKept = 0;
};

State answerOf(const hgmm::Occupancy& o) {
    if (o.occupied > o.free && o.occupied > o.unknown) return occupied;
    return o.free > o.unknown ? free_ : unknown;
}

Shares sharesOf(const Map& map, const Room& room) {
    std::vector<hgmm::Occupancy> answers(room.states.size());
    map.occupancy(room.centres_map.data(), answers.size(), answers.data());
    double known = 0, notKnown = 0;
    Shares shares;
    for (std::size_t i = 0; i < answers.size(); ++i) {
        const State before = room.states[i], after = answerOf(answers[i]);
        const bool wasKnown = before != unknown;
        (wasKnown ? known : notKnown) += 1;
        if (!wasKnown)
            shares.unknownKept += after == unknown ? 1 : 0;
        else if (after == before)
            shares.same += 1;
        else if (after != unknown)
            shares.opposite += 1;
    }
    shares.same /= known;
    shares.opposite /= known;
    shares.unknownKept /= notKnown;
    return shares;
}

hgmm::Pose turned(double angle_rad, const Eigen::Vector3d& t) {
    return {Eigen::AngleAxisd(angle_rad, Eigen::Vector3d::UnitZ()).toRotationMatrix(), t};
}

TEST(KnownCells, MakeAMapThatSaysTheSame) {
    // In line with the lattices of coverage, and far away and turned.
    for (const Room& r :
         {room(0.125, {}), room(0.1, turned(0.4, {500000.03, -20.01, 3.3}))}) {
        const Map map = Map::fromCells(r.cells);
        const Shares shares = sharesOf(map, r);
        EXPECT_GE(shares.same, 0.998) << r.cells.edge_m;
        EXPECT_LE(shares.opposite, 0.001) << r.cells.edge_m;
        EXPECT_GE(shares.unknownKept, 0.95) << r.cells.edge_m;
        const std::vector<std::uint8_t> saved = map.save();
        const Shares loaded = sharesOf(Map::load(saved.data(), saved.size()), r);
        EXPECT_GE(loaded.same, 0.995) << r.cells.edge_m;
        EXPECT_LE(loaded.opposite, 0.002) << r.cells.edge_m;
    }
}

TEST(KnownCells, OneLayerOfThemIsAMapOfAPlanarLaser) {
    Room r = room(0.05, turned(-0.2, {1.01, 2.02, 0}));
    // The layer at 0.5 m, moved to the plane of cells 0.
    Room layer;
    layer.cells.edge_m = 0.05;
    layer.cells.T_map_cells = r.cells.T_map_cells;
    for (std::size_t i = 0; i < r.states.size(); ++i)
        if (std::abs(r.centres_map[i].z() - 0.525) < 1e-6) {
            layer.centres_map.push_back(r.centres_map[i] - Eigen::Vector3d(0, 0, 0.5));
            layer.states.push_back(r.states[i]);
        }
    const auto copyLayer = [](const auto& from, auto& to) {
        for (const auto& cube : from)
            if (cube.low[2] == 10) to.push_back({{cube.low[0], cube.low[1], 0}, 1});
    };
    copyLayer(r.cells.occupied, layer.cells.occupied);
    copyLayer(r.cells.free, layer.cells.free);
    const Shares shares = sharesOf(Map::fromCells(layer.cells), layer);
    EXPECT_GE(shares.same, 0.998);
    EXPECT_LE(shares.opposite, 0.001);
    EXPECT_GE(shares.unknownKept, 0.95);
}

TEST(KnownCells, CubesAreTheirCells) {
    KnownCells cubes, cells;
    cubes.edge_m = cells.edge_m = 0.1;
    cubes.free = {{{-7, 2, 5}, 9}};
    cubes.occupied = {{{2, 2, 5}, 1}};
    cells.occupied = cubes.occupied;
    for (int k = 0; k < 729; ++k)
        cells.free.push_back({{k % 9 - 7, k / 9 % 9 + 2, k / 81 + 5}, 1});
    EXPECT_EQ(Map::fromCells(cubes).save(), Map::fromCells(cells).save());
}

TEST(KnownCells, WallsAreSeenFromTheFreeSide) {
    KnownCells cells;
    cells.edge_m = 0.1;
    for (int y = 0; y < 12; ++y)
        for (int z = 0; z < 12; ++z) {
            cells.occupied.push_back({{5, y, z}, 1});
            cells.free.push_back({{4, y, z}, 1});
        }
    const Map map = Map::fromCells(cells);
    ASSERT_GT(map.mixture().size(), 0U);
    for (std::size_t i = 0; i < map.mixture().size(); ++i)
        EXPECT_TRUE(map.viewDirections()[i].direction.isApprox(-Eigen::Vector3d::UnitX()));
    const auto hit = map.castRay({0.42, 0.6, 0.6}, Eigen::Vector3d::UnitX());
    ASSERT_TRUE(hit);
    EXPECT_NEAR(hit->range_m, 0.55 - 0.42, 0.05);
    EXPECT_GT(map.distance({0.2, 0.6, 0.6}).distance_m, 0.3);
}

TEST(KnownCells, MalformedOnesAreRefused) {
    KnownCells cells;
    EXPECT_THROW(Map::fromCells(cells), std::invalid_argument);  // no edge
    cells.edge_m = 0.1;
    EXPECT_TRUE(Map::fromCells(cells).empty());
    cells.free = {{{0, 0, 0}, 0}};
    EXPECT_THROW(Map::fromCells(cells), std::invalid_argument);
    cells.free = {{{std::numeric_limits<std::int32_t>::max(), 0, 0}, 1}};
    EXPECT_THROW(Map::fromCells(cells), std::invalid_argument);
    cells.free = {{{0, 0, 0}, KnownCells::kFarthest}};
    EXPECT_THROW(Map::fromCells(cells), std::invalid_argument);
    cells.free = {{{0, 0, 0}, 1}};
    cells.T_map_cells.R *= 2;
    EXPECT_THROW(Map::fromCells(cells), std::invalid_argument);
}

TEST(KnownPoints, FartherThanMapsGoIsRefused) {
    EXPECT_THROW(Map::fromPoints({{1e12, 0, 0}, {1e12, 1, 0}}), std::invalid_argument);
    KnownCells cells;
    cells.edge_m = 100;
    cells.occupied = {{{KnownCells::kFarthest, 0, 0}, 1}};
    EXPECT_THROW(Map::fromCells(cells), std::invalid_argument);
}

TEST(KnownPoints, MakeSurfacesAndNothingFree) {
    std::vector<Eigen::Vector3d> points_map;
    for (int i = 0; i < 100; ++i)
        for (int j = 0; j < 100; ++j)
            points_map.emplace_back(4000.0 + 0.02 * i, 0.02 * j, 1.0);
    points_map.emplace_back(std::nan(""), 0, 0);
    const Map map = Map::fromPoints(points_map);
    EXPECT_GT(map.occupancy({4001, 1, 1}).occupied, 0.9);
    EXPECT_GT(map.occupancy({4001, 1, 1.2}).unknown, 0.99);
    EXPECT_EQ(map.freeMixture().size(), 0U);
    EXPECT_NEAR(map.distance({4001, 1, 1.5}).distance_m, 0.5, 0.01);
    EXPECT_NEAR(map.mixture().totalSupport(), 10000, 1);
    EXPECT_TRUE(Map::fromPoints({}).empty());
    EXPECT_THROW(Map::fromPoints({{0, 0, 0}, {1e9, 0, 0}}), std::invalid_argument);
}

}  // namespace
