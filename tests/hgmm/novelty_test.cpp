#include "fusion/novelty.h"

#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <iostream>
#include <random>

#include "fusion/update.h"
#include "hgmm/map.h"
#include "hgmm/scan.h"
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

/// Largest standard deviation within the plane of a laser across a component's longer axis
/// [m].
double largestThickness(const Mixture<3>& mixture, const Eigen::Matrix3d& R_map_laser) {
    double largest = 0;
    for (std::size_t i = 0; i < mixture.size(); ++i) {
        const Eigen::Matrix2d plane =
            (R_map_laser.transpose() * mixture[i].covariance * R_map_laser)
                .topLeftCorner<2, 2>();
        const Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> eigen(plane);
        largest = std::max(largest, std::sqrt(eigen.eigenvalues()[0]));
    }
    return largest;
}

TEST(Novelty, ComponentsDoNotGrowOverARoom) {
    // Legs of chairs and people: a planar laser hits something at any range. It is mounted
    // aslant, and the robot sways.
    const Eigen::Matrix3d mounted =
        Eigen::AngleAxisd(0.6, Eigen::Vector3d(1, 2, 0).normalized()).toRotationMatrix();
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
        scan.T_map_sensor.R = mounted * (pitch * roll).toRotationMatrix();
        map.insert(scan);
        growing.insert(scan);
    }
    // A component may reach the limit, and a last scan push it over. Cells at 4 m: 44 cm.
    EXPECT_LT(largestThickness(map.mixture(), mounted), 1.5 * 0.29 * 0.44);
    EXPECT_GT(largestThickness(growing.mixture(), mounted),
              2 * largestThickness(map.mixture(), mounted));
    std::cout << "thickest component: " << largestThickness(map.mixture(), mounted)
              << " m of " << map.mixture().size() << "; without a limit "
              << largestThickness(growing.mixture(), mounted) << " m of "
              << growing.mixture().size() << "\n";
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
    params.carving.carvedSupport = 1.0;  // nothing else removes components
    Map map(params);
    map.insert(bushFrom({-20, 0, 0}, 1));
    const double limit_m = params.novelty.maxThickness * params.cells.edgeAt(2.5);
    ASSERT_GT(largestSmallestAxis(map.mixture()), limit_m);
    std::size_t oversized = 0, removed = 0;
    for (unsigned k = 0; k < 8; ++k) {
        const InsertReport report = map.insert(bushFrom({-2, 0, 0}, 2 + k));
        oversized += report.componentsOversized;
        removed += report.componentsRemoved;
    }
    EXPECT_GT(oversized, 0U);
    EXPECT_GT(removed, 0U);
    EXPECT_LT(largestSmallestAxis(map.mixture()), limit_m);
}

TEST(Novelty, WhatHasGivenAllAwayIsRemovedWhateverMinSupport) {
    MapParams params;
    params.carving.carvedSupport = 1.0;
    params.carving.minSupport = 0.0;
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
    params.carving.carvedSupport = 1.0;
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
