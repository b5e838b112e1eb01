#include "hgmm/evaluation/voxel_traversal.h"

#include <gtest/gtest.h>

#include <cmath>
#include <set>
#include <tuple>

#include "hgmm/evaluation/split.h"

using namespace hgmm::evaluation;

namespace {

/// Length of a segment within a cell [m]; below 0 if it misses the cell.
double lengthWithin(const VoxelIndex& v, const Eigen::Vector3d& from,
                    const Eigen::Vector3d& to, double edge_m) {
    double enter = 0.0, leave = 1.0;
    for (int axis = 0; axis < 3; ++axis) {
        const double length = to[axis] - from[axis];
        const double a = (v[axis] * edge_m - from[axis]) / length;
        const double b = ((v[axis] + 1) * edge_m - from[axis]) / length;
        enter = std::max(enter, std::min(a, b));
        leave = std::min(leave, std::max(a, b));
    }
    return (leave - enter) * (to - from).norm();
}

}  // namespace

TEST(TraverseVoxels, VisitsTheCellsThatTheSegmentPasses) {
    std::mt19937_64 stream(5);
    const auto random = [&] { return 4.0 * nextUniform(stream) - 2.0; };
    for (int trial = 0; trial < 300; ++trial) {
        const Eigen::Vector3d from(random(), random(), random());
        const Eigen::Vector3d to(random(), random(), random());
        std::set<std::tuple<int, int, int>> visited;
        VoxelIndex previous = voxelOf(from, 0.3);
        traverseVoxels(from, to, 0.3, [&](const VoxelIndex& v) {
            EXPECT_TRUE(visited.emplace(v.x(), v.y(), v.z()).second);
            EXPECT_LE((v - previous).cwiseAbs().sum(), 1);
            previous = v;
        });
        const VoxelIndex last = voxelOf(to, 0.3);
        for (int x = -7; x < 7; ++x)
            for (int y = -7; y < 7; ++y)
                for (int z = -7; z < 7; ++z) {
                    const VoxelIndex v(x, y, z);
                    const double length_m = lengthWithin(v, from, to, 0.3);
                    if (std::abs(length_m) < 1e-9) continue;  // a matter of rounding
                    EXPECT_EQ(visited.count({x, y, z}) == 1, length_m > 0 && v != last);
                }
    }
}

TEST(TraverseVoxels, EndsWhereverThePointsLie) {
    const auto count = [](const Eigen::Vector3d& from, const Eigen::Vector3d& to,
                          double edge_m = 0.1) {
        int n = 0;
        traverseVoxels(from, to, edge_m, [&](const VoxelIndex&) { ++n; });
        return n;
    };
    EXPECT_EQ(count({0.05, 0.05, 0.05}, {0.05, 0.05, 0.05}), 0);
    EXPECT_EQ(count({0.05, 0.05, 0.05}, {0.95, 0.05, 0.05}), 9);
    EXPECT_EQ(count({0.0, 0.0, 0.0}, {-0.375, 0.375, -0.375}, 0.125), 9)
        << "along a diagonal of corners";
    EXPECT_EQ(count({1e6 + 0.05, 0.05, 0.05}, {1e6 + 0.95, 0.0500001, 0.05}), 9);
}

TEST(VoxelHash, FindsWhatWasMade) {
    VoxelHash<int> hash;
    EXPECT_EQ(hash.find({0, 0, 0}), nullptr);
    int n = 0;
    for (int x = -9; x < 9; ++x)
        for (int y = -9; y < 9; ++y)
            for (int z = -9; z < 9; ++z) hash.cell(hash.numberOf({x, y, z})) = n++;
    EXPECT_EQ(hash.size(), 18U * 18U * 18U);
    n = 0;
    for (int x = -9; x < 9; ++x)
        for (int y = -9; y < 9; ++y)
            for (int z = -9; z < 9; ++z, ++n) {
                ASSERT_NE(hash.find({x, y, z}), nullptr);
                EXPECT_EQ(*hash.find({x, y, z}), n);
                EXPECT_EQ(hash.numberOf({x, y, z}), static_cast<std::size_t>(n));
            }
    EXPECT_EQ(hash.find({9, 0, 0}), nullptr);
    hash.clear();
    EXPECT_EQ(hash.find({0, 0, 0}), nullptr);
}
