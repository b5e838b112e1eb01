#include "hgmm/occupancy.h"

#include <gtest/gtest.h>
#include <omp.h>

#include <cstring>
#include <iostream>
#include <limits>

#include "planted_mixture.h"
#include "scenes.h"

namespace hgmm {
namespace {

using namespace testing;
using test::uniform;

const Map& room() {
    static const Map map = mapOf(RoomScanner(), 8);
    return map;
}

Eigen::Vector3d randomPoint(std::mt19937_64& engine, double size) {
    return {uniform(engine, -size, size), uniform(engine, -size, size),
            uniform(engine, -size, size)};
}

void expectSane(const Occupancy& o) {
    ASSERT_TRUE(o.occupied >= 0 && o.occupied <= 1 && o.free >= 0 && o.free <= 1 &&
                o.unknown >= 0 && o.unknown <= 1);
    ASSERT_NEAR(o.occupied + o.free + o.unknown, 1, 1e-6);
    ASSERT_TRUE(std::isfinite(o.alongRay_m));
    ASSERT_TRUE(std::isfinite(o.variance_m2));
    ASSERT_GE(o.variance_m2, 0);
}

TEST(Occupancy, IsADistributionEverywhere) {
    std::mt19937_64 engine(1);
    std::vector<Eigen::Vector3d> points;
    for (int i = 0; i < 1000000; ++i)
        points.push_back(randomPoint(engine, i % 100 == 0 ? 1e6 : i % 10 == 0 ? 40 : 4.5));
    std::vector<Occupancy> answers(points.size());
    room().occupancy(points.data(), points.size(), answers.data());
    std::size_t occupied = 0, free = 0, unknown = 0;
    for (const Occupancy& o : answers) {
        expectSane(o);
        occupied += o.occupied > 0.5F;
        free += o.free > 0.5F;
        unknown += o.unknown > 0.5F;
    }
    EXPECT_GT(occupied, 1000U);
    EXPECT_GT(free, 100000U);
    EXPECT_GT(unknown, 100000U);
}

TEST(Occupancy, IsUnknownWhereThereIsNothingAndForBadPoints) {
    const double nan = std::numeric_limits<double>::quiet_NaN();
    const double inf = std::numeric_limits<double>::infinity();
    for (const double v : {nan, inf, -inf, 1e6, -1e6, 1e30, 1e300})
        for (const Eigen::Vector3d& p : {Eigen::Vector3d(v, 0, 1), Eigen::Vector3d(0, v, 1),
                                         Eigen::Vector3d(v, v, v)}) {
            for (std::size_t level = 0; level < room().levelCount(); ++level) {
                const Occupancy o = room().occupancy(p, level);
                expectSane(o);
                EXPECT_EQ(o.unknown, 1.F) << p.transpose();
                EXPECT_EQ(o.alongRay_m, 0.F);
                EXPECT_TRUE(room().occupancyGradient(p, level).isZero());
            }
        }
    EXPECT_EQ(Map().occupancy({0, 0, 0}).unknown, 1.F);
    EXPECT_TRUE(Map().occupancyGradient({0, 0, 0}).isZero());
    EXPECT_FALSE(Map().castRay({0, 0, 0}, {1, 0, 0}));
    EXPECT_THROW(room().occupancy({0, 0, 0}, 5), std::out_of_range);
    EXPECT_THROW(room().occupancyGradient({0, 0, 0}, 5), std::out_of_range);
    Occupancy answer;
    const Eigen::Vector3d p(0, 0, 0);
    EXPECT_THROW(room().occupancy(&p, 1, &answer, 5), std::out_of_range);
    room().occupancy(nullptr, 0, nullptr);
}

TEST(Occupancy, GradientIsThatOfCentralDifferences) {
    std::mt19937_64 engine(2);
    int compared = 0, near = 0, disagreed = 0;
    for (int i = 0; i < 4000; ++i) {
        // Half of them at walls, half anywhere in the room.
        Eigen::Vector3d p(uniform(engine, -3.9, 3.9), uniform(engine, -2.9, 2.9),
                          uniform(engine, 0.1, 2.4));
        if (i % 2 == 0) p.x() = 4 + uniform(engine, -0.06, 0.02);
        const Eigen::Vector3d g = room().occupancyGradient(p);
        ASSERT_TRUE(g.allFinite());
        Eigen::Vector3d fine, coarse;
        // P is a float: steps must be wide enough to see through its rounding.
        for (int d = 0; d < 3; ++d) {
            const auto difference = [&](double h) {
                const Eigen::Vector3d e = h * Eigen::Vector3d::Unit(d);
                return (double(room().occupancy(p + e).occupied) -
                        double(room().occupancy(p - e).occupied)) /
                       (2 * h);
            };
            fine[d] = difference(2e-4);
            coarse[d] = difference(4e-4);
        }
        // Where the two disagree a component's cut-off lies between, or the field bends.
        if ((fine - coarse).norm() > 1e-3 * coarse.norm() + 1e-4) continue;
        ++compared;
        near += i % 2 == 0;
        const Eigen::Vector3d extrapolated = fine + (fine - coarse) / 3;
        disagreed += (g - extrapolated).norm() > 1e-3 * g.norm() + 6e-4;
    }
    std::cout << "gradient: " << disagreed << " of " << compared << " disagree, " << near
              << " at a wall\n";
    EXPECT_GT(compared, 2000);
    EXPECT_GT(near, 300);
    EXPECT_LE(disagreed, compared / 200);
}

TEST(Occupancy, GradientPointsToTheWall) {
    std::mt19937_64 engine(3);
    for (int i = 0; i < 200; ++i) {
        const Eigen::Vector3d p(3.98, uniform(engine, -2, 2), uniform(engine, 0.5, 2.0));
        EXPECT_GT(room().occupancyGradient(p).normalized().x(), 0.8) << p.transpose();
    }
}

TEST(Occupancy, BatchesAreSingleQueriesBitForBit) {
    std::mt19937_64 engine(4);
    std::vector<Eigen::Vector3d> points;
    for (int i = 0; i < 20001; ++i) points.push_back(randomPoint(engine, 4.5));
    points[77].x() = std::nan("");
    points[78] = {1e9, -1e12, 1e300};
    points[79] = {-1e9, 0, 1};
    const int before = omp_get_max_threads();
    for (const int threads : {1, 2}) {
        omp_set_num_threads(threads);
        for (const std::size_t level : {0, 3}) {
            std::vector<Occupancy> answers(points.size());
            room().occupancy(points.data(), points.size(), answers.data(), level);
            for (std::size_t i = 0; i < points.size(); ++i) {
                const Occupancy one = room().occupancy(points[i], level);
                ASSERT_EQ(std::memcmp(&one, &answers[i], sizeof(one)), 0) << i;
            }
        }
    }
    omp_set_num_threads(before);
}

TEST(Occupancy, FarFromTheOriginIsTheSame) {
    const Eigen::Vector3d far(1e5, -1e5, 2e3);
    // Poses on a grid of 2^-10 m, so that adding the offset rounds nothing.
    Map here, there;
    for (int k = 0; k < 4; ++k) {
        Scan scan = RoomScanner().scan(poseAt(0.25 * k, 0.125 * k, 1.0, 0.5 * k), 30 + k);
        here.insert(scan);
        scan.T_map_sensor.t += far;
        there.insert(scan);
    }
    std::mt19937_64 engine(5);
    for (int i = 0; i < 20000; ++i) {
        Eigen::Vector3d p = randomPoint(engine, 4.5);
        p = (p * 1024).array().round() / 1024;
        const Occupancy a = here.occupancy(p), b = there.occupancy(p + far);
        ASSERT_NEAR(a.occupied, b.occupied, 1e-4);
        ASSERT_NEAR(a.free, b.free, 1e-4);
        ASSERT_NEAR(a.alongRay_m, b.alongRay_m, 1e-3);
    }
    const auto a = here.castRay({0, 0, 1}, {1, 0.2, 0.1});
    const auto b = there.castRay(far + Eigen::Vector3d(0, 0, 1), {1, 0.2, 0.1});
    ASSERT_TRUE(a && b);
    EXPECT_NEAR(a->range_m, b->range_m, 1e-4);
    EXPECT_TRUE((a->point_map + far).isApprox(b->point_map, 1e-9));
}

TEST(Occupancy, AsOneNumberTheUnknownCountsHalf) {
    Occupancy o;
    EXPECT_EQ(o.probability(), 0.5F);
    o = {0.2F, 0.7F, 0.1F, 0, 0};
    EXPECT_NEAR(o.probability(), 0.25F, 1e-6);
}

}  // namespace
}  // namespace hgmm
