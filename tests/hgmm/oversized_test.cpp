#include "fusion/oversized.h"
#include "scan/scan_samples.h"

#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <iostream>
#include <random>

#include "fusion/novelty.h"
#include "hgmm/map.h"

namespace hgmm {
namespace {

/// Whether a component with these standard deviations along the axes, at `mean`, was too
/// thick for a hit in its middle, seen from `sensor`.
bool isOversized(const Eigen::Vector3d& deviations, const Eigen::Vector3d& mean,
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
    ViewDirections views;
    views.pushBack(viewFrom(sensor, mean));
    NoveltyParams params;
    params.maxThickness = maxThickness;
    const CellParams cells;
    FilterParams filter;
    filter.noisePerRange = noisePerRange;
    const SensorGeometry geometry{
        views, ThicknessLimit{maxThickness, cells, filter, sensor, normalOfRays}};
    const NoveltySplit split = splitByNovelty(samples, index, params, &geometry);
    EXPECT_EQ(split.known.size() + split.novel.size(), 1U);
    EXPECT_EQ(split.oversized.size(), split.novel.size());
    if (split.oversized.empty()) return false;
    EXPECT_EQ(split.oversized[0].component, 0U);
    EXPECT_EQ(split.oversized[0].sample, 0U);
    return true;
}

TEST(Oversized, CountsAcrossTheSurfaceThatARayMeets) {
    const Eigen::Vector3d wall(0.02, 2, 1), blob(0.3, 0.3, 0.3), ahead(4, 0, 0);
    // Cells at 4 m have edges of 44 cm: 12.8 cm are too thick.
    EXPECT_FALSE(isOversized(wall, ahead, {0, 0, 0}));
    EXPECT_FALSE(isOversized(wall, ahead, {3.9, 3.9, 0.1}));  // 1.5 deg off its plane
    EXPECT_TRUE(isOversized(blob, ahead, {0, 0, 0}));
    EXPECT_FALSE(isOversized(blob, ahead, {0, 0, 0}, 0.7));
    EXPECT_TRUE(isOversized({0.13, 2, 1}, ahead, {0, 0, 0}));
    EXPECT_FALSE(isOversized({0.125, 2, 1}, ahead, {0, 0, 0}));
    EXPECT_FALSE(isOversized(blob, ahead, {-50, 0, 0}));  // cells of 1.6 m
    // A planar laser's hits are thin across its plane, which makes none of them a surface.
    EXPECT_FALSE(isOversized({0.02, 2, 0.01}, ahead, {0, 0, 0}));
    EXPECT_TRUE(isOversized({0.3, 0.3, 0.01}, ahead, {0, 0, 0}));
    // The same from above is a floor.
    EXPECT_FALSE(isOversized({0.3, 0.3, 0.01}, ahead, {0, 0, 1}));
    // Not so if all rays lie in a plane: it is tilted by less than it takes to see a floor.
    const Eigen::Vector3d sensor(0, 0, 0.02);  // 0.3 deg
    EXPECT_FALSE(isOversized({0.3, 0.3, 0.01}, ahead, sensor));
    const Eigen::Vector3d normal = Eigen::Vector3d(0.02, 0, 4).normalized();
    EXPECT_TRUE(isOversized({0.3, 0.3, 0.01}, ahead, sensor, 0.29, normal));
    EXPECT_FALSE(isOversized({0.02, 2, 0.01}, ahead, sensor, 0.29, normal));
    // Noise of 20 cm at 4 m is no thickness.
    EXPECT_FALSE(isOversized({0.2, 2, 1}, ahead, {0, 0, 0}, 0.29, {0, 0, 0}, 0.05));
    EXPECT_TRUE(isOversized({0.25, 2, 1}, ahead, {0, 0, 0}, 0.29, {0, 0, 0}, 0.05));
}

TEST(Oversized, RaysOfPlanarLasersHaveANormal) {
    const Eigen::Vector3d normal = Eigen::Vector3d(0.1, -0.2, 1).normalized();
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
            g.mean = range(random) * (std::cos(a) * x + std::sin(a) * y +
                                      steepest * slope(random) * normal);
            g.covariance = 1e-4 * Eigen::Matrix3d::Identity();
            samples.pushBack(g);
        }
        return normalOfRays(samples, {});
    };
    EXPECT_GT(std::abs(found(3.14, 0.0).dot(normal)), 1 - 1e-9);
    EXPECT_GT(std::abs(found(1.0, 0.005).dot(normal)), 1 - 1e-4);
    EXPECT_EQ(found(3.14, 0.1), Eigen::Vector3d::Zero().eval()) << "a lidar of some rows";
    EXPECT_EQ(found(0.1, 0.0), Eigen::Vector3d::Zero().eval()) << "any plane along them";
    EXPECT_EQ(normalOfRays({}, {}), Eigen::Vector3d::Zero().eval());
    Mixture<3> atSensor;
    Gaussian<3> g;
    g.support = 1;
    g.mean.setZero();
    g.covariance.setIdentity();
    atSensor.pushBack(g);
    EXPECT_EQ(normalOfRays(atSensor, {}), Eigen::Vector3d::Zero().eval());
}

/// Samples of 1 cm at these places, seen from the origin.
Mixture<3> samplesAt(const std::vector<Eigen::Vector3d>& places) {
    Mixture<3> samples;
    for (const Eigen::Vector3d& place : places) {
        Gaussian<3> g;
        g.support = 1 + double(samples.size() % 3);
        g.mean = place;
        g.covariance = 1e-4 * Eigen::Matrix3d::Identity();
        samples.pushBack(g);
    }
    return samples;
}

/// Standard deviation across the surface that a ray from `sensor` meets [m].
double thicknessOf(const Gaussian<3>& g, const Eigen::Vector3d& sensor) {
    const Eigen::Vector3d u = (sensor - g.mean).normalized(),
                          n = g.covariance.llt().solve(u).normalized();
    return std::sqrt(n.dot(g.covariance * n));
}

/// Splits what is oversized of all of these samples, seen from `sensor`.
struct Splitter {
    CellParams cells;
    FilterParams filter;
    SplitPolicy policy;

    Splitter(const Mixture<3>& samples, const Eigen::Vector3d& sensor,
             const Eigen::Vector3d& normalOfRays = {0, 0, 0})
        : policy{ThicknessLimit{0.29, cells, filter, sensor, normalOfRays}, {}, 0.5} {
        for (std::uint32_t i = 0; i < samples.size(); ++i) policy.relearned.push_back(i);
    }
    Splitter(const Splitter&) = delete;
    InitialMixture of(const Mixture<3>& samples) const {
        CellMoments guess = momentsOfCells(samples, policy.limit.sensorOrigin, cells);
        splitOversized(samples, policy, guess);
        return initialMixture(samples, guess);
    }
};

/// A pole at (8.2, 8.1) and what is behind it, in one cell of 4 m.
Mixture<3> poleAndBackground() {
    return samplesAt({{8.2, 8.1, 0.1},
                      {8.3, 8.0, 0.5},
                      {8.2, 8.1, 0.9},
                      {9.0, 9.4, 0.1},
                      {9.4, 9.0, 0.5},
                      {9.0, 9.4, 0.9}});
}

TEST(Oversized, RelearnedSamplesAreSplitBetweenForegroundAndBackground) {
    const Mixture<3> samples = poleAndBackground();
    const Eigen::Vector3d sensor(0, 0, 0.5);
    const Splitter all(samples, sensor);
    const Mixture<3> thick = initialiseFromCells(samples, sensor, all.cells).mixture;
    ASSERT_EQ(thick.size(), 1U) << "else nothing is to be cut";
    const InitialMixture thin = all.of(samples);
    ASSERT_EQ(thin.mixture.size(), 2U);
    const auto isNear = [](const Gaussian<3>& g) { return g.mean.x() < 8.7; };
    for (std::size_t c = 0; c < 2; ++c) {
        const double x = thin.mixture[c].mean.x();
        EXPECT_NEAR(x, x < 8.7 ? 8.23 : 9.17, 0.05) << "no component between the two";
        EXPECT_LT(thicknessOf(thin.mixture[c], sensor), 0.03);
    }
    const Gaussian<3> whole = mergeMoments(thin.mixture[0], thin.mixture[1]);
    EXPECT_FLOAT_EQ(float(whole.support), float(thick[0].support));
    EXPECT_TRUE(whole.mean.isApprox(thick[0].mean, 1e-6));
    EXPECT_TRUE(whole.covariance.isApprox(thick[0].covariance, 1e-5));
    const Neighbourhoods& n = thin.neighbourhoods;
    for (std::size_t i = 0; i < samples.size(); ++i) {
        ASSERT_EQ(n.begin[i + 1] - n.begin[i], 1U) << "the other part is far off";
        EXPECT_EQ(isNear(thin.mixture[n.component[n.begin[i]]]), isNear(samples[i]));
    }
}

TEST(Oversized, NothingElseIsCut) {
    const Mixture<3> samples = poleAndBackground();
    Splitter some(samples, {0, 0, 0.5});
    some.policy.relearned.clear();
    EXPECT_EQ(some.of(samples).mixture.size(), 1U) << "nothing was known there";
    some.policy.relearned = {4};
    EXPECT_EQ(some.of(samples).mixture.size(), 2U);
    some.policy.minSupport = 7;
    EXPECT_EQ(some.of(samples).mixture.size(), 1U) << "6 hits each are too few";
    some.policy.minSupport = 6;
    EXPECT_EQ(some.of(samples).mixture.size(), 2U);
    // Samples at one place cannot be told apart, however large.
    Mixture<3> large;
    for (int i = 0; i < 3; ++i) {
        large.pushBack(samples[0]);
        Gaussian<3> g = samples[0];
        g.covariance.setIdentity();
        large.set(large.size() - 1, g);
    }
    EXPECT_EQ(Splitter(large, {0, 0, 0.5}).of(large).mixture.size(), 1U);
}

TEST(Oversized, IsCutUntilThin) {
    // Hits all over a cell of 4 m, where cells are of 1 m, and some at one place.
    const CellParams cells;
    const Eigen::Vector3d sensor(0, 0, 0);
    for (unsigned seed = 0; seed < 20; ++seed) {
        std::mt19937_64 random(seed);
        std::uniform_real_distribution<double> within(0.0, 4.0);
        std::vector<Eigen::Vector3d> places;
        for (int i = 0; i < 16; ++i)
            places.emplace_back(48 + within(random), within(random), within(random));
        places.insert(places.end(), 3, {50, 30, 0});
        const Mixture<3> samples = samplesAt(places);
        const Splitter all(samples, sensor);
        const Mixture<3> thin = all.of(samples).mixture;
        for (std::size_t c = 0; c < thin.size(); ++c) {
            const double range = thin[c].mean.norm();
            EXPECT_LE(thicknessOf(thin[c], sensor),
                      std::sqrt(all.policy.limit.maxVarianceAt(range)) + 1e-6)
                << "seed " << seed;
        }
        EXPECT_GT(thin.size(), initialiseFromCells(samples, sensor, cells).mixture.size());
    }
}

TEST(Oversized, IsCutAcrossTheSurfaceAndNotAcrossTheRay) {
    // Two boards, slanted by 60 deg to the ray along x, by their corners. Across the
    // ray they overlap.
    const Eigen::Vector3d along(0.5, 0.866025, 0), normal(-0.866025, 0.5, 0);
    std::vector<Eigen::Vector3d> places;
    for (const double side : {-0.55, 0.55})
        for (const double a : {-1.1, 1.1})
            for (const double z : {1.0, 3.0})
                places.push_back(Eigen::Vector3d(50, 2, z) + a * along + side * normal);
    const Mixture<3> samples = samplesAt(places);
    const Eigen::Vector3d sensor(0, 2, 2);
    const Mixture<3> thin = Splitter(samples, sensor).of(samples).mixture;
    ASSERT_EQ(thin.size(), 2U);
    // Supports differ, so that means are not in the middles; across the ray it would be
    // 0.5.
    EXPECT_GT(std::abs((thin[0].mean - thin[1].mean).normalized().dot(normal)), 0.8);
}

TEST(Oversized, PlanarLasersAreCutWithinTheirPlane) {
    // Flat in the plane of a laser that is tilted by 0.6 deg, which its sensor is just off.
    const Eigen::Vector3d normal = Eigen::Vector3d(0.01, 0, 1).normalized(),
                          sensor(0, 0, 0.05);
    std::vector<Eigen::Vector3d> places;
    for (const double x : {8.3, 9.5})
        for (const double y : {8.2, 9.2}) places.emplace_back(x, y, -0.01 * x);
    const Mixture<3> samples = samplesAt(places);
    EXPECT_EQ(Splitter(samples, sensor).of(samples).mixture.size(), 1U) << "a floor";
    EXPECT_GT(Splitter(samples, sensor, normal).of(samples).mixture.size(), 1U);
}

/// A lidar of 16 rows sees a sparse bush at 50 m, half of whose rays reach a wall behind:
/// the same hits at every scan, but for noise.
class RestingLidar {
 public:
    explicit RestingLidar(unsigned seed) : random_(seed) {
        std::uniform_real_distribution<double> uniform(0.0, 1.0);
        for (int row = -8; row < 8; ++row)
            for (int column = -200; column < 200; ++column) {
                const double elevation = 2 * row * M_PI / 180,
                             azimuth = 0.2 * column * M_PI / 180;
                const Eigen::Vector3d ray(std::cos(elevation) * std::cos(azimuth),
                                          std::cos(elevation) * std::sin(azimuth),
                                          std::sin(elevation));
                // A ball of 1.5 m around (50, 0, 0).
                const double middle = 50 * ray.x(),
                             squared = 1.5 * 1.5 - (50 * 50 - middle * middle);
                if (squared > 0 && uniform(random_) < 0.5)
                    bush_.push_back(
                        (middle + std::sqrt(squared) * (2 * uniform(random_) - 1)) * ray);
                else
                    wall_.push_back(58 / ray.x() * ray);
            }
    }
    InsertReport insertInto(Map& map) {
        std::normal_distribution<double> noise(0.0, 0.02);
        Scan scan;
        for (const auto* hits : {&bush_, &wall_})
            for (const Eigen::Vector3d& hit : *hits) {
                const Eigen::Vector3f p =
                    (hit + noise(random_) * hit.normalized()).cast<float>();
                scan.pushBack(p.x(), p.y(), p.z());
            }
        return map.insert(scan);
    }
    /// Mean P(occupied) at the hits of the bush.
    double probability(const Map& map) const {
        double sum = 0;
        for (const Eigen::Vector3d& hit : bush_) sum += map.occupancy(hit).probability();
        return sum / double(bush_.size());
    }

 private:
    std::mt19937_64 random_;
    std::vector<Eigen::Vector3d> bush_, wall_;
};

TEST(Oversized, SparseClutterIsLearntTwiceAtMost) {
    constexpr int kSeeds = 8;
    double first = 0, last = 0;
    for (unsigned seed = 1; seed <= kSeeds; ++seed) {
        RestingLidar lidar(seed);
        Map map;
        lidar.insertInto(map);
        first += lidar.probability(map) / kSeeds;
        lidar.insertInto(map);
        std::size_t oversized = 0;
        for (int k = 2; k < 16; ++k) oversized += lidar.insertInto(map).componentsOversized;
        last += lidar.probability(map) / kSeeds;
        EXPECT_EQ(oversized, 0U) << "seed " << seed;
    }
    std::cout << "probability " << first << ", after 16 scans " << last << "\n";
    EXPECT_GT(last, first);
}

}  // namespace
}  // namespace hgmm
