#include <gtest/gtest.h>

#include <vector>

#include "hgmm/projection.h"

namespace hgmm {
namespace {

/// Walls across x, 1 m apart from x = 1 on, each of them twice.
Mixture<3> doubledWalls(int n) {
    Mixture<3> mixture;
    for (int i = 0; i < 2 * n; ++i) {
        Gaussian<3> wall;
        wall.support = 10;
        wall.mean = Gaussian<3>::Vector(1 + i / 2, 0, 0);
        wall.covariance.diagonal() = Gaussian<3>::Vector(1e-4, 0.25, 1);
        mixture.pushBack(wall);
    }
    return mixture;
}

std::vector<std::uint32_t> indices(const SurfaceProjection<3>& surfaces, std::size_t count,
                                   float maxSquaredDistance_m2) {
    std::vector<std::uint32_t> all;
    for (const auto& projection :
         surfaces.neighbours({0, 0, 0}, count, maxSquaredDistance_m2))
        all.push_back(projection.component);
    return all;
}

TEST(SurfaceNeighbours, EqualOnesGoByIndexAndTheLimitIsPartOfTheRange) {
    using Indices = std::vector<std::uint32_t>;
    const SurfaceProjection<3> surfaces(doubledWalls(8));
    EXPECT_EQ(indices(surfaces, 5, 1e9F), (Indices{0, 1, 2, 3, 4}));
    EXPECT_EQ(indices(surfaces, 3, 1e9F), (Indices{0, 1, 2}));
    EXPECT_EQ(indices(surfaces, 99, 4.F), (Indices{0, 1, 2, 3}));
    EXPECT_EQ(indices(surfaces, 3, 4.F), (Indices{0, 1, 2}));
    EXPECT_EQ(indices(surfaces, 99, 0.99F), Indices{});
    EXPECT_EQ(indices(surfaces, 0, 1e9F), Indices{});
    EXPECT_EQ(indices(surfaces, 99, 1e9F).size(), 16U);
}

TEST(SurfaceNeighbours, BoundsOfWallsAreWorkedOutByHand) {
    EXPECT_FALSE(SurfaceProjection<3>().bounds());
    const auto bounds = SurfaceProjection<3>(doubledWalls(3)).bounds();
    ASSERT_TRUE(bounds);
    // 2.4 standard deviations: 0.01, 0.5 and 1 m.
    const float low[] = {0.976F, -1.2F, -2.4F}, high[] = {3.024F, 1.2F, 2.4F};
    for (std::size_t d = 0; d < 3; ++d) {
        EXPECT_NEAR(bounds->first[d], low[d], 1e-5);
        EXPECT_NEAR(bounds->second[d], high[d], 1e-5);
    }
}

}  // namespace
}  // namespace hgmm
