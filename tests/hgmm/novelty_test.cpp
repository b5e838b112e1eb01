#include "hgmm/novelty.h"

#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <iostream>
#include <random>

#include "hgmm/filter.h"
#include "hgmm/map.h"
#include "hgmm/update.h"
#include "room_scanner.h"

namespace hgmm {
namespace {

using testing::Box;
using testing::poseAt;
using testing::RoomScanner;

double novelShare(const InsertReport& report) {
    return double(report.novelSamples) / double(report.samples);
}

TEST(Novelty, AgreesWithADirectTest) {
    Map map;
    map.insert(RoomScanner().scan(poseAt(0, 0, 1), 1));
    const Mixture<3>& mixture = map.mixture();
    const Mixture<3> samples =
        transformed(filterScan(RoomScanner().scan(poseAt(0.4, 0.3, 1.2), 2), {}),
                    poseAt(0.4, 0.3, 0.2));
    ComponentIndex index;
    index.rebuild(mixture);
    NoveltyParams params;
    params.maxMahalanobis = 2.0;  // so that there are both kinds
    const NoveltySplit split = splitByNovelty(samples, index, params);
    ASSERT_EQ(split.novel.size() + split.known.size(), samples.size());
    EXPECT_GT(split.novel.size(), 10U);
    EXPECT_GT(split.known.size(), 10U);
    std::size_t k = 0;
    for (std::uint32_t i = 0; i < samples.size(); ++i) {
        const float p[3] = {samples.mean[0][i], samples.mean[1][i], samples.mean[2][i]};
        std::vector<std::uint32_t> near;
        for (std::uint32_t j = 0; j < mixture.size(); ++j)
            if (index.factor(j).squaredMahalanobis(p) <= 4.F) near.push_back(j);
        if (near.empty()) {
            EXPECT_TRUE(std::binary_search(split.novel.begin(), split.novel.end(), i));
            continue;
        }
        ASSERT_EQ(split.known.at(k), i);
        const auto& n = split.neighbourhoods;
        EXPECT_EQ(near, std::vector<std::uint32_t>(n.component.begin() + n.begin[k],
                                                   n.component.begin() + n.begin[k + 1]));
        ++k;
    }
}

TEST(Novelty, TheSameScanAgainAddsLittle) {
    Map map;
    const Scan scan = RoomScanner().scan(poseAt(0.3, -0.2, 1.0), 3);
    map.insert(scan);
    const std::size_t before = map.mixture().size();
    ASSERT_GT(before, 20U);
    const InsertReport again = map.insert(scan);
    EXPECT_LT(double(again.componentsAdded), 0.02 * double(before));
    const InsertReport otherNoise =
        map.insert(RoomScanner().scan(poseAt(0.3, -0.2, 1.0), 4));
    EXPECT_LT(double(otherNoise.componentsAdded), 0.02 * double(before));
    std::cout << "same scan again: +" << again.componentsAdded << " of " << before
              << " components; same place, new noise: +" << otherNoise.componentsAdded
              << "\n";
}

TEST(Novelty, ANewWallIsNovel) {
    const Box partition{Eigen::Vector3d(2.0, -1.5, 0.0), Eigen::Vector3d(2.1, 1.5, 2.0)};
    const RoomScanner before;
    RoomScanner after = before;
    after.furniture.push_back(partition);
    Map map;
    for (int i = 0; i < 4; ++i)
        map.insert(before.scan(poseAt(0.2 * i, 0.1 * i, 1.2), 50 + i));
    const Scan scan = after.scan(poseAt(0, 0, 1.2), 60);
    Scan wall;  // what that scan sees of the partition
    wall.T_map_sensor = scan.T_map_sensor;
    for (std::size_t i = 0; i < scan.size(); ++i)
        if (std::abs(scan.x[i] - 2.0F) < 0.03F && std::abs(scan.y[i]) < 1.5F)
            wall.pushBack(scan.x[i], scan.y[i], scan.z[i]);
    const InsertReport report = map.insert(wall);
    ASSERT_GT(report.samples, 100U);
    EXPECT_GE(novelShare(report), 0.98);
    std::cout << "new wall: " << 100 * novelShare(report) << " % novel\n";
}

TEST(Novelty, DoesNotDriftAsTheMapGrows) {
    // A thousand-fold support elsewhere shrinks every weight here, and must change nothing.
    const Scan here = RoomScanner().scan(poseAt(0, 0, 1), 7);
    RoomScanner elsewhere;
    Map small, large;
    small.insert(here);
    large.insert(here);
    for (int i = 1; i < 20; ++i) large.insert(elsewhere.scan(poseAt(0, 0, 1), 100 + i));
    Scan far = elsewhere.scan(poseAt(0, 0, 1), 50);
    far.T_map_sensor.t.x() += 200;
    for (int i = 0; i < 30; ++i) large.insert(far);
    const Scan probe = RoomScanner().scan(poseAt(0, 0, 1), 8);
    EXPECT_NEAR(novelShare(Map(small).insert(probe)), novelShare(Map(large).insert(probe)),
                0.02);
}

/// Whether a component with these standard deviations along the axes, at `mean`, was too
/// thick for a hit in its middle, seen from `sensor`.
bool isOutgrown(const Eigen::Vector3d& deviations, const Eigen::Vector3d& mean,
                const Eigen::Vector3d& sensor, double maxThickness = 0.29,
                const Eigen::Vector3d& normalOfRays = {0, 0, 0},
                double noisePerRange = 0.001) {
    Mixture<3> map, samples;
    Gaussian<3> g;
    g.support = 100;
    g.mean = mean;
    g.covariance = deviations.cwiseAbs2().asDiagonal();
    map.pushBack(g);
    g.support = 3;
    g.covariance = 1e-4 * Eigen::Matrix3d::Identity();
    samples.pushBack(g);
    ComponentIndex index;
    index.rebuild(map);
    Views views;
    views.pushBack(viewFrom(sensor, mean));
    NoveltyParams params;
    params.maxThickness = maxThickness;
    const CellParams cells;
    FilterParams filter;
    filter.noisePerRange = noisePerRange;
    const Sighting sighting{views, sensor, cells, filter, normalOfRays};
    const NoveltySplit split = splitByNovelty(samples, index, params, &sighting);
    EXPECT_EQ(split.known.size() + split.novel.size(), 1U);
    EXPECT_EQ(split.outgrown.size(), split.novel.size());
    if (split.outgrown.empty()) return false;
    EXPECT_EQ(split.outgrown[0].component, 0U);
    EXPECT_EQ(split.outgrown[0].sample, 0U);
    return true;
}

TEST(Novelty, ThicknessCountsAcrossTheSurfaceThatARayMeets) {
    const Eigen::Vector3d wall(0.02, 2, 1), blob(0.3, 0.3, 0.3), ahead(4, 0, 0);
    // Cells at 4 m have edges of 44 cm: 12.8 cm are too thick.
    EXPECT_FALSE(isOutgrown(wall, ahead, {0, 0, 0}));
    EXPECT_FALSE(isOutgrown(wall, ahead, {3.9, 3.9, 0.1}));  // 1.5 deg off its plane
    EXPECT_TRUE(isOutgrown(blob, ahead, {0, 0, 0}));
    EXPECT_FALSE(isOutgrown(blob, ahead, {0, 0, 0}, 0.7));
    EXPECT_TRUE(isOutgrown({0.13, 2, 1}, ahead, {0, 0, 0}));
    EXPECT_FALSE(isOutgrown({0.125, 2, 1}, ahead, {0, 0, 0}));
    EXPECT_FALSE(isOutgrown(blob, ahead, {-50, 0, 0}));  // cells of 1.6 m
    // A planar laser's hits are thin across its plane, which makes none of them a surface.
    EXPECT_FALSE(isOutgrown({0.02, 2, 0.01}, ahead, {0, 0, 0}));
    EXPECT_TRUE(isOutgrown({0.3, 0.3, 0.01}, ahead, {0, 0, 0}));
    // The same from above is a floor.
    EXPECT_FALSE(isOutgrown({0.3, 0.3, 0.01}, ahead, {0, 0, 1}));
    // Not so if all rays lie in a plane: it is tilted by less than it takes to see a floor.
    const Eigen::Vector3d sensor(0, 0, 0.02);  // 0.3 deg
    EXPECT_FALSE(isOutgrown({0.3, 0.3, 0.01}, ahead, sensor));
    const Eigen::Vector3d normal = Eigen::Vector3d(0.02, 0, 4).normalized();
    EXPECT_TRUE(isOutgrown({0.3, 0.3, 0.01}, ahead, sensor, 0.29, normal));
    EXPECT_FALSE(isOutgrown({0.02, 2, 0.01}, ahead, sensor, 0.29, normal));
    // Noise of 20 cm at 4 m is no thickness.
    EXPECT_FALSE(isOutgrown({0.2, 2, 1}, ahead, {0, 0, 0}, 0.29, {0, 0, 0}, 0.05));
    EXPECT_TRUE(isOutgrown({0.25, 2, 1}, ahead, {0, 0, 0}, 0.29, {0, 0, 0}, 0.05));
}

TEST(Novelty, RaysOfPlanarLasersHaveANormal) {
    const Eigen::Vector3d origin(3, -2, 1),
        normal = Eigen::Vector3d(0.1, -0.2, 1).normalized();
    const Eigen::Vector3d x = normal.unitOrthogonal(), y = normal.cross(x);
    std::mt19937_64 random(4);
    std::uniform_real_distribution<double> range(0.1, 30.0), slope(-1.0, 1.0);
    // Rays over `aperture` [rad], up to `steepest` off the plane.
    const auto found = [&](double aperture, double steepest) {
        Mixture<3> samples;
        for (int i = 0; i < 500; ++i) {
            const double a = aperture * i / 499.0;
            Gaussian<3> g;
            g.support = 1;
            g.mean = origin + range(random) * (std::cos(a) * x + std::sin(a) * y +
                                               steepest * slope(random) * normal);
            g.covariance = 1e-4 * Eigen::Matrix3d::Identity();
            samples.pushBack(g);
        }
        return normalOfRays(samples, origin);
    };
    EXPECT_GT(std::abs(found(3.14, 0.0).dot(normal)), 1 - 1e-9);
    EXPECT_GT(std::abs(found(1.0, 0.005).dot(normal)), 1 - 1e-4);
    EXPECT_EQ(found(3.14, 0.1), Eigen::Vector3d::Zero().eval()) << "a lidar of some rows";
    EXPECT_EQ(found(0.1, 0.0), Eigen::Vector3d::Zero().eval()) << "any plane along them";
    EXPECT_EQ(normalOfRays({}, origin), Eigen::Vector3d::Zero().eval());
    Mixture<3> atSensor;
    Gaussian<3> g;
    g.support = 1;
    g.mean = origin;
    g.covariance.setIdentity();
    atSensor.pushBack(g);
    EXPECT_EQ(normalOfRays(atSensor, origin), Eigen::Vector3d::Zero().eval());
}

/// Largest standard deviation within the plane z = 0 across a component's longer axis [m].
double largestThickness(const Mixture<3>& mixture) {
    double largest = 0;
    for (std::size_t i = 0; i < mixture.size(); ++i) {
        const Eigen::Matrix2d plane = mixture[i].covariance.topLeftCorner<2, 2>();
        const Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> eigen(plane);
        largest = std::max(largest, std::sqrt(eigen.eigenvalues()[0]));
    }
    return largest;
}

TEST(Novelty, ComponentsDoNotGrowOverARoom) {
    // Legs of chairs and people: a planar laser hits something at any range. The robot
    // sways.
    std::mt19937_64 random(11);
    std::uniform_real_distribution<float> range(1.F, 4.F);
    std::uniform_real_distribution<double> tilt(-0.0035, 0.0035);  // 0.2 deg
    MapParams params, unlimited;
    unlimited.novelty.maxThickness = 1000;
    Map map(params), growing(unlimited);
    for (int k = 0; k < 150; ++k) {
        Scan scan;
        for (int i = 0; i < 181; ++i) {
            const float r = range(random), a = 0.0174533F * float(i);
            scan.pushBack(r * std::cos(a), r * std::sin(a), 0.F);
        }
        const Eigen::AngleAxisd pitch(tilt(random), Eigen::Vector3d::UnitY()),
            roll(tilt(random), Eigen::Vector3d::UnitX());
        scan.T_map_sensor.R = (pitch * roll).toRotationMatrix();
        map.insert(scan);
        growing.insert(scan);
    }
    // A component may reach the limit, and a last scan push it over. Cells at 4 m: 44 cm.
    EXPECT_LT(largestThickness(map.mixture()), 1.5 * 0.29 * 0.44);
    EXPECT_GT(largestThickness(growing.mixture()), 2 * largestThickness(map.mixture()));
    std::cout << "thickest component: " << largestThickness(map.mixture()) << " m of "
              << map.mixture().size() << "; without a limit "
              << largestThickness(growing.mixture()) << " m of " << growing.mixture().size()
              << "\n";
}

/// Hits all over a ball of half a metre around (0, 0, 0).
Scan bushFrom(const Eigen::Vector3d& sensor, unsigned seed) {
    std::mt19937_64 random(seed);
    std::uniform_real_distribution<double> within(-0.5, 0.5);
    Scan scan;
    scan.T_map_sensor.t = sensor;
    while (scan.size() < 1500) {
        const Eigen::Vector3d hit(within(random), within(random), within(random));
        if (hit.norm() > 0.5) continue;
        const Eigen::Vector3f p = (hit - sensor).cast<float>();
        scan.pushBack(p.x(), p.y(), p.z());
    }
    return scan;
}

/// Largest standard deviation of a component along its shortest axis [m].
double largestSmallestAxis(const Mixture<3>& mixture) {
    double largest = 0;
    for (std::size_t i = 0; i < mixture.size(); ++i) {
        const Eigen::Matrix3d covariance = mixture[i].covariance;
        const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> eigen(covariance);
        largest = std::max(largest, std::sqrt(eigen.eigenvalues()[0]));
    }
    return largest;
}

TEST(Novelty, WhatIsCoarseFromAfarIsReplacedFromNear) {
    MapParams params;
    params.contradiction.contradictedKeep = 1.0;  // nothing else removes components
    Map map(params);
    map.insert(bushFrom({-20, 0, 0}, 1));
    const double limit_m = params.novelty.maxThickness * params.cells.edgeAt(2.5);
    ASSERT_GT(largestSmallestAxis(map.mixture()), limit_m);
    std::size_t outgrown = 0, removed = 0;
    for (unsigned k = 0; k < 8; ++k) {
        const InsertReport report = map.insert(bushFrom({-2, 0, 0}, 2 + k));
        outgrown += report.componentsOutgrown;
        removed += report.componentsRemoved;
    }
    EXPECT_GT(outgrown, 0U);
    EXPECT_GT(removed, 0U);
    EXPECT_LT(largestSmallestAxis(map.mixture()), limit_m);
}

TEST(Novelty, WhatHasGivenAllAwayIsRemovedWhateverMinSupport) {
    MapParams params;
    params.contradiction.contradictedKeep = 1.0;
    params.contradiction.minSupport = 0.0;
    Map map(params);
    map.insert(bushFrom({-20, 0, 0}, 1));
    std::size_t removed = 0;
    for (unsigned k = 0; k < 8; ++k)
        removed += map.insert(bushFrom({-2, 0, 0}, 2 + k)).componentsRemoved;
    EXPECT_GT(removed, 0U);
    for (const float support : map.mixture().support) EXPECT_GT(support, kNoSupport);
}

TEST(Novelty, WhatOthersExplainDoesNotWearACoarseNeighbourDown) {
    // A known wall, and a bush before it seen from afar, whose components reach the wall at
    // 2 to 3 sigma: seeing the wall alone from near takes next to nothing from the bush.
    MapParams params;
    params.contradiction.contradictedKeep = 1.0;
    Map map(params);
    std::mt19937_64 random(3);
    std::uniform_real_distribution<float> across(-0.6F, 0.6F);
    const auto insertWall = [&](int scans) {
        for (int k = 0; k < scans; ++k) {
            Scan wall;
            wall.T_map_sensor.t = {-2, 0, 0};
            for (int i = 0; i < 1500; ++i)
                wall.pushBack(2.6F, across(random), across(random));
            map.insert(wall);
        }
    };
    const auto supportOfBush = [&] {
        double sum = 0;
        for (std::size_t i = 0; i < map.mixture().size(); ++i)
            if (map.origin().x() + map.mixture().mean[0][i] < 0.4)
                sum += map.mixture().support[i];
        return sum;
    };
    insertWall(3);
    map.insert(bushFrom({-20, 0, 0}, 1));
    const double before = supportOfBush();
    ASSERT_GT(before, 0);
    insertWall(10);
    EXPECT_GT(supportOfBush(), 0.9 * before);
}

TEST(Novelty, ParametersOutOfRangeAreNamed) {
    NoveltyParams params;
    params.maxMahalanobis = ComponentIndex::kSigmas + 1;
    EXPECT_THROW(params.validate(), std::invalid_argument);
    params = {};
    params.maxThickness = 0;
    EXPECT_THROW(params.validate(), std::invalid_argument);
}

}  // namespace
}  // namespace hgmm
