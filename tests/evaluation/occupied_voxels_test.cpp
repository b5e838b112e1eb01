#include "hgmm/evaluation/occupied_voxels.h"

#include <gtest/gtest.h>

#include <stdexcept>

using namespace hgmm::evaluation;

namespace {

/// Occupied within a ball, unknown beyond a larger one.
const Eigen::Vector3d kCentre(0.3, -0.2, 1.0);
constexpr double kRadius_m = 0.4, kKnown_m = 0.6;

void ball(const Eigen::Vector3d* points_map, std::size_t n, Answer* answers) {
    for (std::size_t i = 0; i < n; ++i) {
        const double distance = (points_map[i] - kCentre).norm();
        answers[i] = {distance < kRadius_m  ? 0.9
                      : distance > kKnown_m ? 0.7
                                            : 0.1,
                      distance > kKnown_m};
    }
}

}  // namespace

TEST(OccupiedVoxels, FillABallAndNothingElse) {
    const VoxelGrid grid =
        gridAround({{-0.7, -1.1, 0.2}, {1.2, 0.8, 1.9}}, 0.02, /*outermostShare=*/0.0);
    const Points voxels = occupiedVoxels(ball, grid);
    for (const Eigen::Vector3d& p : voxels) EXPECT_LT((p - kCentre).norm(), kRadius_m);
    const double volume = 4.0 / 3.0 * M_PI * std::pow(kRadius_m, 3);
    EXPECT_NEAR(static_cast<double>(voxels.size()) * std::pow(0.02, 3), volume,
                0.01 * volume);
}

TEST(OccupiedVoxels, GridsLieOnMultiplesOfTheEdgeAndLeaveOutliersOut) {
    Points points;
    for (int i = 0; i <= 1000; ++i) points.emplace_back(0.001 * i, 0.5, -0.3);
    points.emplace_back(500.0, 500.0, -500.0);
    const VoxelGrid grid = gridAround(points, 0.25, 0.01);
    EXPECT_TRUE(grid.min_map.isApprox(Eigen::Vector3d(0.0, 0.5, -0.5)));
    EXPECT_EQ(grid.count, Eigen::Vector3i(4, 1, 1));
}

TEST(OccupiedVoxels, BadGridsAreRefused) {
    const Points two{{0, 0, 0}, {1000, 1000, 1000}};
    EXPECT_THROW(gridAround({}, 0.1), std::invalid_argument);
    EXPECT_THROW(gridAround(two, 0.0), std::invalid_argument);
    EXPECT_THROW(gridAround(two, 0.1, 0.5), std::invalid_argument);
    EXPECT_THROW(gridAround(two, 0.1, 0.0), std::invalid_argument) << "10^12 voxels";
    EXPECT_EQ(gridAround(two, 10.0, 0.0).count, Eigen::Vector3i(101, 101, 101));
}
