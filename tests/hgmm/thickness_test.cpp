#include "hgmm/thickness.h"

#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <iostream>
#include <random>

#include "hgmm/map.h"
#include "hgmm/novelty.h"

namespace hgmm {
namespace {

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
    const Sighting sighting{
        views, ThicknessLimit{maxThickness, cells, filter, sensor, normalOfRays}};
    const NoveltySplit split = splitByNovelty(samples, index, params, &sighting);
    EXPECT_EQ(split.known.size() + split.novel.size(), 1U);
    EXPECT_EQ(split.outgrown.size(), split.novel.size());
    if (split.outgrown.empty()) return false;
    EXPECT_EQ(split.outgrown[0].component, 0U);
    EXPECT_EQ(split.outgrown[0].sample, 0U);
    return true;
}

TEST(Thickness, CountsAcrossTheSurfaceThatARayMeets) {
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

TEST(Thickness, RaysOfPlanarLasersHaveANormal) {
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
        return normalOfRays(samples);
    };
    EXPECT_GT(std::abs(found(3.14, 0.0).dot(normal)), 1 - 1e-9);
    EXPECT_GT(std::abs(found(1.0, 0.005).dot(normal)), 1 - 1e-4);
    EXPECT_EQ(found(3.14, 0.1), Eigen::Vector3d::Zero().eval()) << "a lidar of some rows";
    EXPECT_EQ(found(0.1, 0.0), Eigen::Vector3d::Zero().eval()) << "any plane along them";
    EXPECT_EQ(normalOfRays({}), Eigen::Vector3d::Zero().eval());
    Mixture<3> atSensor;
    Gaussian<3> g;
    g.support = 1;
    g.mean.setZero();
    g.covariance.setIdentity();
    atSensor.pushBack(g);
    EXPECT_EQ(normalOfRays(atSensor), Eigen::Vector3d::Zero().eval());
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

TEST(Thickness, FirstGuessesAreThinWhereSamplesAreFew) {
    // Three hits of a pole at 8 m and three of what is 1.5 m behind it, in one large cell.
    const Mixture<3> samples = samplesAt({{8.2, 8.1, 0.1},
                                          {8.3, 8.0, 0.5},
                                          {8.2, 8.1, 0.9},
                                          {9.0, 9.4, 0.1},
                                          {9.4, 9.0, 0.5},
                                          {9.0, 9.4, 0.9}});
    const CellParams cells;
    const FilterParams filter;
    const Eigen::Vector3d sensor(0, 0, 0.5);
    const ThicknessLimit limit{0.29, cells, filter, sensor};
    const Mixture<3> thick = initialiseFromCells(samples, sensor, cells).mixture;
    ASSERT_EQ(thick.size(), 1U) << "else nothing is to be cut";
    const InitialMixture thin = initialiseFromCells(samples, sensor, cells, &limit);
    ASSERT_EQ(thin.mixture.size(), 2U);
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
        const bool isFirst =
            (thin.mixture[0].mean.x() < 8.7) == (samples[i].mean.x() < 8.7);
        const std::uint32_t own = isFirst ? 0 : 1;
        EXPECT_TRUE(std::count(n.component.begin() + n.begin[i],
                               n.component.begin() + n.begin[i + 1], own) == 1)
            << "sample " << i << " knows its component";
    }
}

TEST(Thickness, FirstGuessesAreCutUntilThin) {
    std::mt19937_64 random(5);
    std::uniform_real_distribution<double> within(-2.0, 2.0);
    std::vector<Eigen::Vector3d> places;  // all in one cell of 4 m
    for (int i = 0; i < 12; ++i)
        places.emplace_back(50 + within(random), 2 + within(random), 2 + within(random));
    places.insert(places.end(), 6, {50, 30, 0});  // at one place
    const Mixture<3> samples = samplesAt(places);
    const CellParams cells;
    const FilterParams filter;
    const ThicknessLimit limit{0.29, cells, filter, {0, 0, 0}};
    const auto thickest = [&](const Mixture<3>& mixture) {
        double largest = 0;
        for (std::size_t c = 0; c < mixture.size(); ++c)
            largest = std::max(largest, thicknessOf(mixture[c], {0, 0, 0}));
        return largest;
    };
    const double allowed = std::sqrt(limit.maxVarianceAt(52));
    EXPECT_GT(thickest(initialiseFromCells(samples, {0, 0, 0}, cells).mixture), allowed);
    EXPECT_LT(thickest(initialiseFromCells(samples, {0, 0, 0}, cells, &limit).mixture),
              allowed);
}

/// A lidar of 16 rows sees a sparse bush at 50 m, half of whose rays reach a wall behind.
TEST(Thickness, SparseClutterIsLearntOnce) {
    std::mt19937_64 random(1);
    std::uniform_real_distribution<double> uniform(0.0, 1.0);
    std::normal_distribution<double> noise(0.0, 0.02);
    std::vector<Eigen::Vector3d> bush, wall;
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
            if (squared > 0 && uniform(random) < 0.5)
                bush.push_back((middle + std::sqrt(squared) * (2 * uniform(random) - 1)) *
                               ray);
            else
                wall.push_back(58 / ray.x() * ray);
        }
    Map map;
    const auto insert = [&] {
        Scan scan;
        for (const auto* hits : {&bush, &wall})
            for (const Eigen::Vector3d& hit : *hits) {
                const Eigen::Vector3f p =
                    (hit + noise(random) * hit.normalized()).cast<float>();
                scan.pushBack(p.x(), p.y(), p.z());
            }
        return map.insert(scan);
    };
    const auto probability = [&] {
        double sum = 0;
        for (const Eigen::Vector3d& hit : bush) sum += map.occupancy(hit).probability();
        return sum / double(bush.size());
    };
    insert();
    const double first = probability();
    std::size_t outgrown = 0;
    for (int k = 1; k < 16; ++k) outgrown += insert().componentsOutgrown;
    std::cout << bush.size() << " hits: probability " << first << ", after 16 scans "
              << probability() << "\n";
    EXPECT_EQ(outgrown, 0U);
    EXPECT_GT(probability(), 0.8);
    EXPECT_GT(probability(), first - 0.02);
}

}  // namespace
}  // namespace hgmm
