#include "hgmm/evaluation/ndt_baseline.h"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>

#include "wall_scene.h"

using namespace hgmm::evaluation;
using namespace wall_scene;

namespace {

struct Moments {
    Eigen::Vector3d mean = Eigen::Vector3d::Zero();
    Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
};

/// In two passes.
Moments momentsOf(const Points& points) {
    Moments m;
    for (const auto& p : points) m.mean += p / static_cast<double>(points.size());
    for (const auto& p : points)
        m.covariance += (p - m.mean) * (p - m.mean).transpose() /
                        (static_cast<double>(points.size()) - 1.0);
    return m;
}

hgmm::Scan scanOf(const Points& points_map) {
    hgmm::Scan scan;
    for (const auto& p : points_map) addPoint(scan, p);
    return scan;
}

}  // namespace

TEST(NdtBaseline, CellsHoldMeanAndCovarianceOfTheirPoints) {
    const Points points = randomPoints(3000, 7);
    NdtBaseline map(0.25);
    map.insert(scanOf({points.begin(), points.begin() + 1000}));
    map.insert(scanOf({points.begin() + 1000, points.end()}));
    for (int cell = 0; cell < 64; ++cell) {
        const Eigen::Vector3d low(0.25 * (cell % 4), 0.25 * (cell / 4 % 4),
                                  0.25 * (cell / 16));
        Points own;
        for (const auto& p : points)
            if (((p - low).array() >= 0).all() && ((p - low).array() < 0.25).all())
                own.push_back(p);
        ASSERT_GE(own.size(), 20U);
        const Moments expected = momentsOf(own);
        const auto gaussian = map.gaussianAt(low + Eigen::Vector3d::Constant(0.1));
        ASSERT_TRUE(gaussian);
        // Points pass through float in the sensor frame, some 1e-7 m.
        EXPECT_LT((gaussian->mean_map - expected.mean).norm(), 1e-6);
        const Eigen::Matrix3d product = gaussian->information * expected.covariance;
        EXPECT_LT((product - Eigen::Matrix3d::Identity()).norm(), 1e-4);
        const double logDensity =
            -0.5 * std::log((2 * M_PI * expected.covariance).determinant());
        EXPECT_NEAR(gaussian->logDensityAtMean, logDensity, 1e-4);
    }
}

TEST(NdtBaseline, ScoresTheDensityOfTheCellsAround) {
    const Points points = randomPoints(600, 3);
    NdtBaseline map(0.25);
    map.insert(scanOf(points));
    for (const auto& p : randomPoints(50, 4)) {
        double density = 0.0;
        for (int i = 0; i < 27; ++i)
            if (const auto gaussian =
                    map.gaussianAt(p + 0.25 * Eigen::Vector3d(i % 3 - 1, i / 3 % 3 - 1,
                                                              static_cast<int>(i / 9) - 1)))
                density += gaussian->density(p);
        ASSERT_GT(density, 0.0);
        EXPECT_FALSE(ask(map, p).unknown);
        EXPECT_NEAR(ask(map, p).probability, density / (density + 1), 1e-9);
    }
    EXPECT_EQ(map.meaning(), Meaning::surfaceLikelihood);
}

TEST(NdtBaseline, AWallIsAThinGaussian) {
    NdtBaseline map(0.1);
    map.insert(wallScan());
    const auto gaussian = map.gaussianAt({kWall_m, 0.55, 0.75});
    ASSERT_TRUE(gaussian);
    // The wall has no thickness: its smallest eigenvalue is a hundredth of the largest.
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(gaussian->information);
    EXPECT_NEAR(solver.eigenvalues()[2] / solver.eigenvalues()[0], 100.0, 1e-6);
    EXPECT_NEAR(std::abs(solver.eigenvectors()(0, 2)), 1.0, 1e-4);
    double before = 1.0;
    for (double x = kWall_m; x < kWall_m + 0.1; x += 0.01) {
        EXPECT_LT(ask(map, x).probability, before) << x;
        before = ask(map, x).probability;
    }
    EXPECT_FALSE(ask(map, kWall_m + 0.15).unknown) << "the wall is in the next cell";
    EXPECT_TRUE(ask(map, kWall_m + 0.2).unknown);
    EXPECT_EQ(ask(map, kWall_m + 0.2).probability, 0.0);
    EXPECT_TRUE(ask(map, 2.0).unknown) << "free space is not known";
}

TEST(NdtBaseline, CellsNeedFivePoints) {
    NdtBaseline map(0.1);
    map.insert(rays(4));
    EXPECT_TRUE(ask(map, kWall_m).unknown);
    map.insert(rays(1));
    // All in one spot: it is taken to spread over a thousandth of the cell.
    const auto gaussian = map.gaussianAt({kWall_m, 0.53, 0.73});
    ASSERT_TRUE(gaussian);
    EXPECT_TRUE(gaussian->information.allFinite());
    EXPECT_GT(ask(map, kWall_m).probability, 0.999);
    EXPECT_LT(ask(map, kWall_m + 0.01).probability, 1e-6);
}
