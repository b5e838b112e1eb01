#include "hgmm/view_directions.h"

#include <gtest/gtest.h>

namespace hgmm {
namespace {

ViewDirection view(double x, double y, double z, double range) {
    return {Eigen::Vector3d(x, y, z).normalized(), range};
}

TEST(ViewDirections, MergeIsTheSupportWeightedMean) {
    const ViewDirection v = merged(view(1, 0, 0, 2), 3, view(0, 1, 0, 6), 1);
    EXPECT_TRUE(v.direction.isApprox(Eigen::Vector3d(3, 1, 0).normalized(), 1e-12));
    EXPECT_DOUBLE_EQ(v.range_m, 3.0);
    const ViewDirection swapped = merged(view(0, 1, 0, 6), 1, view(1, 0, 0, 2), 3);
    EXPECT_TRUE(swapped.direction.isApprox(v.direction, 1e-12));
}

TEST(ViewDirections, MergeWithTheUnknownIsTheKnownOne) {
    const ViewDirection known = view(0, 0, 1, 5), unknown;
    EXPECT_FALSE(unknown.known());
    for (const ViewDirection& v :
         {merged(known, 1, unknown, 1e9), merged(unknown, 1e9, known, 1)}) {
        EXPECT_EQ(v.direction, known.direction);
        EXPECT_EQ(v.range_m, 5.0);
    }
    EXPECT_FALSE(merged(unknown, 1, unknown, 1).known());
}

TEST(ViewDirections, OppositeDirectionsKeepTheFirst) {
    const ViewDirection v = merged(view(1, 1, 0, 1), 7, view(-1, -1, 0, 3), 7);
    EXPECT_TRUE(v.direction.isApprox(view(1, 1, 0, 1).direction, 1e-12));
    EXPECT_DOUBLE_EQ(v.range_m, 2.0);
    // Not quite balanced: the stronger one wins.
    EXPECT_GT(merged(view(1, 0, 0, 1), 1, view(-1, 0, 0, 1), 2)
                  .direction.dot(Eigen::Vector3d(-1, 0, 0)),
              0.999);
}

TEST(ViewDirections, PointFromTheSurfaceToTheSensor) {
    const ViewDirection v = viewFrom({1, 2, 7}, {1, 2, 3});
    EXPECT_EQ(v.direction, Eigen::Vector3d(0, 0, 1));
    EXPECT_EQ(v.range_m, 4.0);
    EXPECT_FALSE(viewFrom({1, 2, 3}, {1, 2, 3}).known());
}

TEST(ViewDirections, FollowRemovals) {
    ViewDirections views;
    for (int i = 1; i <= 4; ++i) views.pushBack(view(i, 1, 0, i));
    views.removeSwap(1);
    ASSERT_EQ(views.size(), 3U);
    EXPECT_EQ(views[0].range_m, 1);
    EXPECT_EQ(views[1].range_m, 4);
    EXPECT_EQ(views[2].range_m, 3);
    views.removeSwap(2);
    views.removeSwap(0);
    ASSERT_EQ(views.size(), 1U);
    EXPECT_EQ(views[0].range_m, 4);
    views.set(0, view(0, 0, -1, 9));
    EXPECT_EQ(views[0].direction.z(), -1);
}

}  // namespace
}  // namespace hgmm
