#include "hgmm/evaluation/ndt_om_baseline.h"

#include <gtest/gtest.h>

#include <cmath>

#include "wall_scene.h"

using namespace hgmm::evaluation;
using namespace wall_scene;

namespace {

double fromOdds(double odds) {
    return odds / (1.0 + odds);
}

}  // namespace

TEST(NdtOmBaseline, ASingleRayToTheWall) {
    NdtOmBaseline map(0.1);
    EXPECT_TRUE(ask(map, kWall_m).unknown) << "nothing was seen yet";
    map.insert(rays(1));
    // 0.6 for one hit, 0.4 for one ray through a cell without points.
    EXPECT_NEAR(ask(map, kWall_m).probability, 0.6, 1e-6);
    for (double x = 1.03; x < 2.98; x += 0.1) {
        EXPECT_FALSE(ask(map, x).unknown) << x;
        EXPECT_NEAR(ask(map, x).probability, 0.4, 1e-6) << x;
    }
    for (const Answer& answer :
         {ask(map, kWall_m + 0.1), ask(map, 0.93), ask(map, 2.0, 0.63), ask(map, 1e6)}) {
        EXPECT_TRUE(answer.unknown);
        EXPECT_EQ(answer.probability, 0.5);
    }
    // A ray to a cell weighs as many as its points, whether in one scan or in three.
    map.insert(rays(2));
    EXPECT_NEAR(map.cellProbability({kWall_m, 0.53, 0.73}).value(),
                fromOdds(std::pow(1.5, 3)), 1e-6);
    EXPECT_NEAR(ask(map, 2.0).probability, fromOdds(std::pow(1.5, -3)), 1e-6);
    map.insert(rays(100));
    EXPECT_NEAR(map.cellProbability({kWall_m, 0.53, 0.73}).value(), 0.999, 1e-6);
    EXPECT_NEAR(ask(map, 2.0).probability, 0.001, 1e-6);
}

TEST(NdtOmBaseline, RaysThroughASurfaceCountByTheirDistanceFromIt) {
    // Six points around one spot, so that the Gaussian is round: sigma is s * sqrt(6 / 5).
    const double s = 0.01;
    const Eigen::Vector3d spot(2.05, 0.55, 0.75);
    hgmm::Scan ball;
    for (int axis = 0; axis < 3; ++axis)
        for (const double sign : {-1.0, 1.0})
            addPoint(ball, spot + sign * s * std::sqrt(3.0) * Eigen::Vector3d::Unit(axis));
    const double sigma = s * std::sqrt(6.0 / 5.0);
    for (const double offset_m : {0.0, 0.01, 0.02, 0.03}) {
        NdtOmBaseline map(0.1);
        map.insert(ball);
        const double before = std::pow(1.5, 6);
        EXPECT_NEAR(map.cellProbability(spot).value(), fromOdds(before), 1e-6);
        // A ray that passes the spot at a distance, and ends far behind.
        Eigen::Vector3d end = origin_map() + 3.0 * (spot - origin_map());
        const Eigen::Vector3d across =
            (spot - origin_map()).cross(Eigen::Vector3d::UnitZ()).normalized();
        end += 3.0 * offset_m * across;
        map.insert(rays(1, end));
        const Eigen::Vector3d ray = (end - origin_map()).normalized();
        const double distance = (spot - origin_map()).cross(ray).norm();
        const double miss = 0.5 - 0.1 * std::exp(-0.5 * std::pow(distance / sigma, 2));
        EXPECT_NEAR(map.cellProbability(spot).value(), fromOdds(before * miss / (1 - miss)),
                    1e-5)
            << offset_m;
    }
}

TEST(NdtOmBaseline, ARayThatEndsAtASurfaceDoesNotFreeIt) {
    // The surface reaches from its cell into the next, where the ray ends.
    hgmm::Scan ball;
    const Eigen::Vector3d spot(2.095, 0.55, 0.75);
    for (int axis = 0; axis < 3; ++axis)
        for (const double sign : {-1.0, 1.0})
            addPoint(ball, spot + sign * 0.004 * Eigen::Vector3d::Unit(axis));
    NdtOmBaseline map(0.1);
    map.insert(ball);
    const double before = map.cellProbability(spot).value();
    map.insert(rays(1, spot + 0.007 * (spot - origin_map()).normalized()));
    // 1 - exp(-(0.007 / 0.02)^2 / 2) = 0.06 of a miss.
    const double after = map.cellProbability(spot).value();
    EXPECT_LT(after, before);
    const double oddsRatio = after / (1 - after) / (before / (1 - before));
    EXPECT_NEAR(oddsRatio, 1.0 - 4 * 0.1 * 0.0594, 3e-3);
}

TEST(NdtOmBaseline, TheGaussianSaysWhereInTheCell) {
    NdtOmBaseline map(0.1);
    map.insert(wallScan());
    const double cell = map.cellProbability({kWall_m, 0.55, 0.75}).value();
    EXPECT_NEAR(cell, 0.999, 1e-6) << "25 points, clamped";
    EXPECT_GT(ask(map, kWall_m, 0.55, 0.75).probability, cell);
    double before = 1.0;
    for (double x = kWall_m; x < 3.1; x += 0.01) {
        EXPECT_LT(ask(map, x, 0.55, 0.75).probability, before) << x;
        before = ask(map, x, 0.55, 0.75).probability;
    }
    EXPECT_LT(before, 1e-3) << "the wall is thin, and the rest of the cell is free";
    EXPECT_FALSE(ask(map, 3.09, 0.55, 0.75).unknown);
}

TEST(NdtOmBaseline, CountsTheMemoryOfItsCells) {
    NdtOmBaseline map(0.1);
    EXPECT_EQ(map.liveBytes(), 0U);
    map.insert(rays(1));
    const std::size_t one = map.liveBytes();
    // 21 cells of at least an index, log-odds and a number; one of them with the moments.
    EXPECT_GT(one, 21 * (12U + 8U) + 10 * sizeof(double));
    for (int i = 0; i < 20; ++i) map.insert(rays(1));
    EXPECT_EQ(map.liveBytes(), one) << "the same cells again";
    map.insert(wallScan());
    EXPECT_GT(map.liveBytes(), 50 * one);
}
