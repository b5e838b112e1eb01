#include "occupancy/openings.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <random>
#include <vector>

#include "hgmm/map.h"
#include "occupancy/passed_surfaces.h"
#include "planted_mixture.h"
#include "scan/ray_image.h"

namespace hgmm {
namespace {

using test::normal;
using test::uniform;

constexpr double kSpacing_rad = 0.01;

Coverage::Rays raysOfTest() {
    return {CoverageParams(), kSpacing_rad, Eigen::Vector3d::Zero()};
}

Gaussian<3> pieceAt(const Eigen::Vector3d& mean, const Eigen::Vector3d& sigma,
                    double support = 500) {
    Gaussian<3> g;
    g.support = support;
    g.mean = mean;
    g.covariance = sigma.cwiseAbs2().asDiagonal();
    return g;
}

/// Where rays of a fan about the x axis end that has this many steps to each side.
Mixture<3> fanOfEnds(int steps, double range_m) {
    Mixture<3> ends;
    for (int a = -steps; a <= steps; ++a)
        for (int b = -steps; b <= steps; ++b) {
            Gaussian<3> end = pieceAt(
                range_m *
                    Eigen::Vector3d(1, a * kSpacing_rad, b * kSpacing_rad).normalized(),
                {0.01, 0.01, 0.01}, 1);
            ends.pushBack(end);
        }
    return ends;
}

Coverage passedBy(const Mixture<3>& surfaces, const Mixture<3>& ends) {
    ComponentIndex index;
    index.rebuild(surfaces);
    std::vector<std::uint32_t> all;
    for (std::uint32_t i = 0; i < surfaces.size(); ++i) all.push_back(i);
    return passedSurfaces(surfaces, index, all, 40.F, {ends, Eigen::Vector3d::Zero()},
                          raysOfTest());
}

Coverage passedBy(const Gaussian<3>& surface, const Mixture<3>& ends) {
    Mixture<3> surfaces;
    surfaces.pushBack(surface);
    return passedBy(surfaces, ends);
}

TEST(RayImage, FindsTheRaysAroundADirection) {
    std::mt19937_64 engine(3);
    Mixture<3> ends;
    const Eigen::Vector3d origin(1, 2, 3);
    for (int i = 0; i < 2000; ++i)
        ends.pushBack(pieceAt(
            origin + uniform(engine, 1, 20) *
                         Eigen::Vector3d(normal(engine), normal(engine), normal(engine))
                             .normalized(),
            {0.1, 0.1, 0.1}, 1));
    const RayImage image(ends, origin);
    for (int trial = 0; trial < 300; ++trial) {
        const Eigen::Vector3d u =
            Eigen::Vector3d(normal(engine), normal(engine), normal(engine)).normalized();
        const double angle = uniform(engine, 0.01, 0.5), length = uniform(engine, 0, 15);
        std::size_t expected = 0, found = 0;
        for (std::size_t i = 0; i < ends.size(); ++i) {
            const Eigen::Vector3d ray = ends[i].mean - origin;
            if (ray.norm() >= length && ray.normalized().dot(u) > std::cos(angle))
                ++expected;
        }
        image.visitAround(
            u, RayImage::Cone::ofSine(std::sin(angle)), length,
            [&](const RayImage::Ray& ray) {
                if (ray.length_m >= length && ray.direction.dot(u) > std::cos(angle))
                    ++found;
            });
        EXPECT_EQ(found, expected);
    }
}

TEST(PassedSurfaces, AreThoseThatRaysEndWellBehind) {
    const Gaussian<3> wall = pieceAt({4, 0, 0}, {0.02, 0.3, 0.3});
    EXPECT_FALSE(passedBy(wall, fanOfEnds(20, 6)).empty());
    EXPECT_TRUE(passedBy(wall, fanOfEnds(20, 4)).empty());
    EXPECT_TRUE(passedBy(wall, fanOfEnds(20, 4.12)).empty());
    EXPECT_TRUE(passedBy(wall, fanOfEnds(20, 2)).empty());
    // Beside it.
    EXPECT_TRUE(passedBy(pieceAt({4, 3, 0}, {0.02, 0.3, 0.3}), fanOfEnds(20, 6)).empty());
}

TEST(PassedSurfaces, AreWidePiecesOfManyHits) {
    EXPECT_TRUE(
        passedBy(pieceAt({4, 0, 0}, {0.02, 0.3, 0.3}, 39), fanOfEnds(20, 6)).empty());
    EXPECT_TRUE(passedBy(pieceAt({4, 0, 0}, {0.15, 0.3, 0.3}), fanOfEnds(20, 6)).empty());
    EXPECT_TRUE(passedBy(pieceAt({4, 0, 0}, {0.002, 0.01, 0.3}), fanOfEnds(20, 6)).empty());
}

TEST(PassedSurfaces, AreWallsNearTheSensorThatReachFar) {
    const Coverage all = passedBy(pieceAt({4, 0, 0}, {0.02, 3, 1}), fanOfEnds(20, 6));
    const double aside[3] = {4, 0.8, 0.05};
    EXPECT_GT(all.shareAt(aside), 0.5);
}

TEST(PassedSurfaces, AreCellsAboutThePlaceOnly) {
    const Coverage passed =
        passedBy(pieceAt({4, 0, 0}, {0.02, 0.3, 0.3}), fanOfEnds(20, 6));
    passed.forEachBlock([&](const LatticeCell& block, Coverage::Word) {
        const double edge = 4 * powerOfTwo(block.octave);
        EXPECT_LT(block.x * edge, 4.1);
        EXPECT_GT((block.x + 1) * edge, 3.9);
        EXPECT_LT(std::abs((block.y + 0.5) * edge), 0.3 * std::sqrt(3.0) + edge);
        EXPECT_LT(std::abs((block.z + 0.5) * edge), 0.3 * std::sqrt(3.0) + edge);
    });
    const double inside[3] = {4, 0.05, 0.05}, before[3] = {3.3, 0, 0},
                 behind[3] = {4.7, 0, 0};
    EXPECT_GT(passed.shareAt(inside), 0.5);
    EXPECT_EQ(passed.shareAt(before), 0);
    EXPECT_EQ(passed.shareAt(behind), 0);
}

TEST(PassedSurfaces, NotAFloorThatRaysMeetAtGrazingAngles) {
    Mixture<3> ends;
    std::mt19937_64 engine(4);
    const double height_m = 0.6;
    for (double elevation = 0.02; elevation < 0.4; elevation += 0.01)
        for (double azimuth = -0.4; azimuth < 0.4; azimuth += 0.01) {
            const double range = height_m / std::sin(elevation) + 0.02 * normal(engine);
            ends.pushBack(
                pieceAt(range * Eigen::Vector3d(std::cos(elevation) * std::cos(azimuth),
                                                std::cos(elevation) * std::sin(azimuth),
                                                -std::sin(elevation)),
                        {0.02, 0.02, 0.02}, 1));
        }
    Mixture<3> floor;
    for (double x = 1; x < 25; x += 0.5)
        floor.pushBack(pieceAt({x, 0, -height_m}, {0.4, 0.3, 0.01}));
    EXPECT_TRUE(passedBy(floor, ends).empty());
}

/// Cells of a wall x = 4 in which rays pass, and hits in its cells.
struct Wall {
    Coverage passed;
    Mixture<3> hits;

    void pass(double y, double z) {
        passed.markSegment(Openings::octaveAt(4, raysOfTest()), {3.95, y, z}, {4.05, y, z});
    }
    void hit(double y, double z) {
        hits.pushBack(pieceAt({4, y, z}, {0.01, 0.01, 0.01}, 1));
    }
    void shownTo(Openings& openings) const {
        openings.learn(passed, hits, Eigen::Vector3d::Zero(), raysOfTest());
    }
};

double openAt(const Openings& openings, double y, double z) {
    const double x[3] = {4.0, y, z};
    return openings.at(x);
}

TEST(Openings, AreWhatTwoScansPassUntilARayEndsThere) {
    Wall passed, shut;
    for (double y = -0.5; y < 0.5; y += 0.03)
        for (double z = -0.5; z < 0.5; z += 0.03) passed.pass(y, z), shut.hit(y, z);
    Openings openings;
    passed.shownTo(openings);
    EXPECT_EQ(openAt(openings, 0, 0), 0);
    passed.shownTo(openings);
    EXPECT_EQ(openAt(openings, 0, 0), 1);
    EXPECT_EQ(openAt(openings, 0, 1), 0);
    shut.shownTo(openings);
    EXPECT_EQ(openAt(openings, 0, 0), 0);
    EXPECT_TRUE(openings.empty());
    passed.shownTo(openings);
    EXPECT_EQ(openAt(openings, 0, 0), 0);
}

TEST(Openings, EndWhereRaysOfTheSameScanEnd) {
    Wall edge;
    for (double z = -0.5; z < 0.5; z += 0.03) {
        for (double y = -0.5; y < 0; y += 0.03) edge.pass(y, z);
        for (double y = 0.01; y < 0.5; y += 0.03) edge.hit(y, z);
    }
    edge.pass(0.2, 0.2);
    Openings openings;
    for (int i = 0; i < 5; ++i) edge.shownTo(openings);
    EXPECT_EQ(openAt(openings, -0.3, 0), 1);
    EXPECT_EQ(openAt(openings, 0.2, 0.2), 0);
    EXPECT_EQ(openAt(openings, 0.1, 0), 0);
}

/// A wall x = 4 with a doorway |y| < .5, -1 < z < 1, and a wall x = 7 behind it.
class Doorway {
 public:
    explicit Doorway(bool planar) : planar_(planar) {}

    Scan scan(bool isOpen) {
        Scan scan;
        for (double z = planar_ ? 0 : -0.4; z <= (planar_ ? 0 : 0.4); z += 0.02)
            for (double y = -0.9; y <= 0.9; y += planar_ ? 0.005 : 0.02) {
                const Eigen::Vector3d ray(1, y / 4 + 0.001 * normal(engine_), z);
                const bool passes =
                    isOpen && std::abs(4 * ray.y()) < 0.5 && std::abs(4 * z) < 1;
                const double depth = (passes ? 7 : 4) + 0.01 * normal(engine_);
                scan.pushBack(float(depth), float(depth * ray.y()), float(depth * z));
            }
        return scan;
    }
    void show(Map& map, bool isOpen, int scans) {
        for (int i = 0; i < scans; ++i) map.insert(scan(isOpen));
    }
    /// Mean P(free) in the doorway, at least 15 cm from its frame.
    double freeInDoor(const Map& map) const { return meanAt(map, 0.35, true); }
    /// Mean P(occupied) of the wall, at least 10 cm beside the doorway.
    double occupiedBeside(const Map& map) const {
        double sum = 0;
        int n = 0;
        for (double y = 0.6; y < 0.75; y += 0.05)
            for (const double side : {-1.0, 1.0})
                sum += double(map.occupancy(Eigen::Vector3d(4, side * y, 0)).occupied), ++n;
        return sum / n;
    }

 private:
    double meanAt(const Map& map, double halfWidth, bool free) const {
        double sum = 0;
        int n = 0;
        for (double y = -halfWidth; y <= halfWidth; y += 0.05)
            for (double z = planar_ ? 0 : -0.6; z <= (planar_ ? 0 : 0.6); z += 0.1) {
                const Occupancy answer = map.occupancy(Eigen::Vector3d(4, y, z));
                sum += double(free ? answer.free : answer.occupied), ++n;
            }
        return sum / n;
    }

    bool planar_;
    std::mt19937_64 engine_{7};
};

TEST(Openings, ADoorOpensAndShutsAndItsWallStays) {
    for (const bool planar : {false, true}) {
        SCOPED_TRACE(planar);
        Doorway doorway(planar);
        Map map;
        doorway.show(map, false, 40);
        EXPECT_LT(doorway.freeInDoor(map), 0.1);
        for (int swing = 0; swing < 2; ++swing) {
            doorway.show(map, true, 3);
            EXPECT_GT(doorway.freeInDoor(map), 0.9);
            EXPECT_GT(doorway.occupiedBeside(map), 0.9);
            doorway.show(map, true, 10);
            doorway.show(map, false, 2);
            EXPECT_LT(doorway.freeInDoor(map), 0.1);
            doorway.show(map, false, 10);
        }
    }
}

TEST(Openings, AreSavedAndGoOnAlike) {
    Doorway doorway(false);
    Map map;
    doorway.show(map, false, 30);
    EXPECT_EQ(map.save(Encoding::compact)[4], 4);  // as before there were any
    doorway.show(map, true, 3);
    const std::vector<std::uint8_t> compact = map.save(Encoding::compact),
                                    exact = map.save(Encoding::exact);
    EXPECT_EQ(compact[4], 5);
    EXPECT_GT(doorway.freeInDoor(Map::load(compact.data(), compact.size())), 0.9);
    Map loaded = Map::load(exact.data(), exact.size());
    EXPECT_TRUE(loaded == map);
    Doorway other = doorway;
    doorway.show(map, true, 1);
    other.show(loaded, true, 1);
    EXPECT_TRUE(loaded == map);
}

TEST(Openings, AreInBatchesWhatTheyAreInSingleAnswers) {
    Doorway doorway(false);
    Map map;
    doorway.show(map, false, 30);
    doorway.show(map, true, 3);
    std::mt19937_64 engine(5);
    std::vector<Eigen::Vector3d> points;
    for (int i = 0; i < 3000; ++i)
        points.emplace_back(uniform(engine, 3, 5), uniform(engine, -1, 1),
                            uniform(engine, -1, 1));
    std::vector<Occupancy> answers(points.size());
    map.occupancy(points.data(), points.size(), answers.data());
    for (std::size_t i = 0; i < points.size(); ++i) {
        const Occupancy one = map.occupancy(points[i]);
        ASSERT_EQ(std::memcmp(&one, &answers[i], sizeof(one)), 0) << i;
    }
}

TEST(Openings, AreMergedAndCropped) {
    Doorway doorway(false);
    Map map;
    doorway.show(map, false, 30);
    doorway.show(map, true, 5);
    Map merged;
    merged.merge(map, {Eigen::Matrix3d::Identity(), Eigen::Vector3d::Zero()});
    EXPECT_GT(doorway.freeInDoor(merged), 0.9);
    const Map part = map.crop({Eigen::Vector3d(3, -2, -2), Eigen::Vector3d(5, 2, 2)});
    EXPECT_NEAR(doorway.freeInDoor(part), doorway.freeInDoor(map), 1e-6);
}

}  // namespace
}  // namespace hgmm
