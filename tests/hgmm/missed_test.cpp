#include "fusion/missed.h"

#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <iterator>
#include <numeric>

#include "hgmm/map.h"
#include "planted_mixture.h"

namespace hgmm {
namespace {

using test::normal;
using test::randomCovariance;
using test::uniform;

const Eigen::Vector3d kSensor(1.5, -0.5, 1.0);
constexpr double kSpacing_rad = 0.01;

Gaussian<3> ball(const Eigen::Vector3d& mean, double deviation_m = 0.01,
                 double support = 1.0) {
    Gaussian<3> g;
    g.support = support;
    g.mean = mean;
    g.covariance = deviation_m * deviation_m * Eigen::Matrix3d::Identity();
    return g;
}

/// Surfaces and their indices, asked by scans from kSensor.
struct Asked {
    Mixture<3> surfaces;
    CellParams cells;
    FilterParams filter;
    ThicknessLimit limit{0.29, cells, filter, kSensor};

    std::vector<std::uint32_t> missed(const Mixture<3>& ends,
                                      const std::vector<std::uint32_t>& hit = {},
                                      float maxSupport = 40.F) const {
        ComponentIndex index;
        index.rebuild(surfaces);
        std::vector<std::uint32_t> all(surfaces.size());
        std::iota(all.begin(), all.end(), 0U);
        const RayImage image(ends, kSensor);
        return hgmm::missed(surfaces, hit, maxSupport, {image, limit, kSpacing_rad}, index,
                            all);
    }
};

/// Where rays end on the plane x = 4 m from the sensor, but for those of y > 0, which end
/// on a plane at 2 m.
Mixture<3> wallBehindAnEdge() {
    Mixture<3> ends;
    for (double a = -0.5; a <= 0.5; a += kSpacing_rad)
        for (double b = -0.5; b <= 0.5; b += kSpacing_rad)
            ends.pushBack(ball(kSensor + (a > 0 ? 2.0 : 4.0) * Eigen::Vector3d(1, a, b)));
    return ends;
}

TEST(Missed, DustBesideAnEdgeAndWhatIsJustBehindAWall) {
    Asked map;
    const auto isMissed = [&](double x, double y) {
        map.surfaces = {};
        map.surfaces.pushBack(ball(kSensor + Eigen::Vector3d(x, x * y, 0)));
        return !map.missed(wallBehindAnEdge()).empty();
    };
    EXPECT_TRUE(isMissed(3, -0.3));     // in the open
    EXPECT_TRUE(isMissed(3, -0.01));    // rays at half a degree end at 2 m
    EXPECT_TRUE(isMissed(1.5, 0.3));    // before the near plane
    EXPECT_TRUE(isMissed(4.1, -0.3));   // noise behind the wall
    EXPECT_FALSE(isMissed(4.5, -0.3));  // hidden by it
    EXPECT_FALSE(isMissed(3, 0.3));     // hidden by the near plane
    EXPECT_FALSE(isMissed(3, 0.6));     // beside all rays
    EXPECT_FALSE(isMissed(-3, 0));      // behind the sensor
}

TEST(Missed, NotWhatWasHitOrIsWellSupported) {
    Asked map;
    for (const double support : {1.0, 39.0, 40.0, 1.0})
        map.surfaces.pushBack(ball(kSensor + Eigen::Vector3d(3, -0.5, 0), 0.01, support));
    EXPECT_EQ(map.missed(wallBehindAnEdge(), {0}), (std::vector<std::uint32_t>{1, 3}));
    EXPECT_EQ(map.missed(wallBehindAnEdge(), {3}, 1.F), (std::vector<std::uint32_t>{}));
}

/// What missed() promises, ray by ray.
bool isMissedByDefinition(const Gaussian<3>& g, const Mixture<3>& ends,
                          const ThicknessLimit& limit) {
    const Eigen::Matrix3d covariance = g.covariance;
    const Eigen::Vector3d mean = g.mean - kSensor;
    const double range = mean.norm(), extent = std::sqrt(covariance.trace()) / range;
    for (std::size_t i = 0; i < ends.size(); ++i) {
        const Eigen::Vector3d end = ends[i].mean - kSensor, ray = end.normalized();
        if (end.norm() < range - std::sqrt(limit.maxVarianceAt(range))) continue;
        const double angle = (ray - mean / range).norm();
        if (angle > std::min(0.0625, std::max(extent, 0.5 * kSpacing_rad))) continue;
        if (angle <= 0.5 * kSpacing_rad) return true;
        const Eigen::Vector3d solved = covariance.ldlt().solve(ray);
        const Eigen::Vector3d nearest = ray * (mean.dot(solved) / ray.dot(solved)) - mean;
        if (nearest.dot(covariance.ldlt().solve(nearest)) <= 1.0) return true;
    }
    return false;
}

TEST(Missed, IsWhatItsDefinitionSays) {
    std::mt19937_64 engine(7);
    const auto randomPoint = [&](double nearest, double farthest) -> Eigen::Vector3d {
        const Eigen::Vector3d d(normal(engine), normal(engine), normal(engine));
        return kSensor + uniform(engine, nearest, farthest) * d.normalized();
    };
    Mixture<3> ends;
    for (int i = 0; i < 4000; ++i) ends.pushBack(ball(randomPoint(1, 12)));
    Asked map;
    for (int i = 0; i < 1500; ++i) {
        Gaussian<3> g = ball(randomPoint(0.3, 13));
        g.covariance = uniform(engine, 0.0002, 0.05) * randomCovariance<3>(engine, 20);
        map.surfaces.pushBack(g);
    }
    std::vector<std::uint32_t> expected;
    for (std::uint32_t i = 0; i < map.surfaces.size(); ++i)
        if (isMissedByDefinition(map.surfaces[i], ends, map.limit)) expected.push_back(i);
    EXPECT_GT(expected.size(), 200U);
    EXPECT_LT(expected.size(), 1300U);
    const std::vector<std::uint32_t> found = map.missed(ends);
    std::vector<std::uint32_t> different;
    std::set_symmetric_difference(found.begin(), found.end(), expected.begin(),
                                  expected.end(), std::back_inserter(different));
    EXPECT_LE(different.size(), 3U) << "float factors may differ where it is close";
}

/// A planar laser in the middle of a round room of 4 m radius with four pillars before
/// its wall, seen with range noise of 2 cm; one ray in a hundred ends on dust.
class ParkedLaser {
 public:
    static constexpr int kBesidePillar = 5;  ///< number of a ray

    /// @param hasThing whether a ray ends at 3 m, beside the pillar
    Scan next(double dustShare, bool hasThing = false) {
        Scan scan;
        constexpr int rays = 360;
        for (int i = 0; i < rays; ++i) {
            const double angle = 2 * M_PI * i / rays;
            double range = i % 90 < 4 ? 2.0 : 4.0;
            if (hasThing && i == kBesidePillar) range = 3.0;
            range += 0.02 * normal(engine_);
            if (uniform(engine_, 0, 1) < dustShare) range *= uniform(engine_, 0.1, 0.9);
            scan.pushBack(float(range * std::cos(angle)), float(range * std::sin(angle)),
                          0.F);
        }
        return scan;
    }

 private:
    std::mt19937_64 engine_{3};
};

TEST(Missed, TheMapOfAParkedRobotDoesNotGrow) {
    ParkedLaser laser;
    Map map;
    const auto insert = [&](int scans) {
        for (int i = 0; i < scans; ++i) map.insert(laser.next(0.01));
        return double(map.mixture().size());
    };
    const double soon = insert(300), later = insert(1700);
    EXPECT_LE(later, 1.2 * soon);
    int occupied = 0;
    for (int i = 0; i < 360; ++i)
        if (i % 90 > 10 && i % 90 < 84) {
            const double angle = 2 * M_PI * i / 360;
            occupied +=
                map.occupancy({4 * std::cos(angle), 4 * std::sin(angle), 0}).occupied > 0.5;
        }
    EXPECT_GE(occupied, 0.99 * 4 * 73) << "the wall stays";
}

// Carving does not see that rays pass it: those beside it end at the pillar.
TEST(Missed, WhatIsHitNoMoreIsForgottenAndWhatIsHitNowAndThenStays) {
    const double angle = 2 * M_PI * ParkedLaser::kBesidePillar / 360;
    const Eigen::Vector3d thing(3 * std::cos(angle), 3 * std::sin(angle), 0);
    const auto isThere = [&](const Map& map) {
        return map.occupancy(thing).occupied > 0.5;
    };
    for (const bool isHitAgain : {false, true}) {
        ParkedLaser laser;
        Map map;
        for (int i = 0; i < 20; ++i) map.insert(laser.next(0));
        EXPECT_FALSE(isThere(map));
        for (int i = 0; i < 5; ++i) map.insert(laser.next(0, true));
        EXPECT_TRUE(isThere(map));
        for (int i = 0; i < 100; ++i) map.insert(laser.next(0, isHitAgain && i % 4 == 0));
        EXPECT_EQ(isThere(map), isHitAgain);
    }
}

TEST(Missed, NothingIsForgottenWhereRaysRemoveNothing) {
    MapParams params;
    params.carving.carvedSupport = 1.0;
    ParkedLaser laser;
    Map map(params);
    std::size_t missed = 0, removed = 0;
    for (int i = 0; i < 50; ++i) {
        const InsertReport report = map.insert(laser.next(0.01));
        missed += report.componentsMissed;
        removed += report.componentsRemoved;
    }
    EXPECT_EQ(missed, 0U);
    EXPECT_EQ(removed, 0U);
}

}  // namespace
}  // namespace hgmm
