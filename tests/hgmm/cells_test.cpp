#include "scan/cells.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "hgmm/scan.h"
#include "room_scanner.h"

namespace hgmm {
namespace {

using testing::poseAt;
using testing::RoomScanner;

TEST(Cells, KeepEverySampleAndItsMoments) {
    const Mixture<3> samples = filterScan(RoomScanner().scan(poseAt(0, 0, 1), 1), {});
    const InitialMixture initial =
        initialiseFromCells(samples, Eigen::Vector3d::Zero(), {});
    initial.mixture.check();
    EXPECT_LT(initial.mixture.size(), samples.size() / 4);
    EXPECT_NEAR(initial.mixture.totalSupport(), samples.totalSupport(), 1.0);
    const auto moments = [](const Mixture<3>& m) {
        Gaussian<3> all = m[0];
        for (std::size_t i = 1; i < m.size(); ++i) all = mergeMoments(all, m[i]);
        return all;
    };
    EXPECT_TRUE(moments(initial.mixture).mean.isApprox(moments(samples).mean, 1e-4));
    EXPECT_TRUE(
        moments(initial.mixture).covariance.isApprox(moments(samples).covariance, 1e-4));
}

TEST(Cells, EverySampleHasANeighbourhoodInOrder) {
    const Mixture<3> samples = filterScan(RoomScanner().scan(poseAt(0, 0, 1), 2), {});
    const InitialMixture initial =
        initialiseFromCells(samples, Eigen::Vector3d::Zero(), {});
    const Neighbourhoods& n = initial.neighbourhoods;
    ASSERT_EQ(n.begin.size(), samples.size() + 1);
    EXPECT_EQ(n.begin.front(), 0U);
    EXPECT_EQ(n.begin.back(), n.component.size());
    for (std::size_t i = 0; i < samples.size(); ++i) {
        ASSERT_LT(n.begin[i], n.begin[i + 1]);
        for (std::uint32_t k = n.begin[i]; k < n.begin[i + 1]; ++k) {
            EXPECT_LT(n.component[k], initial.mixture.size());
            if (k > n.begin[i]) {
                EXPECT_LT(n.component[k - 1], n.component[k]);
            }
        }
    }
}

TEST(Cells, SizeFollowsTheRange) {
    // The same pattern, as large as the square root of the range, makes the same number of
    // components.
    const auto components = [](double scale) {
        Mixture<3> samples;
        for (int i = 0; i < 40; ++i)
            for (int j = 0; j < 40; ++j) {
                Gaussian<3> s;
                s.support = 1;
                s.mean << 4 * scale, std::sqrt(scale) * (0.05 * i - 1),
                    std::sqrt(scale) * (0.05 * j - 1);
                s.covariance = 1e-4 * scale * Eigen::Matrix3d::Identity();
                samples.pushBack(s);
            }
        return initialiseFromCells(samples, Eigen::Vector3d::Zero(), {}).mixture.size();
    };
    EXPECT_EQ(components(1), components(16));
    EXPECT_NEAR(double(components(1)), double(components(10)), 0.8 * double(components(1)));
}

TEST(Cells, SparseSamplesShareLargerCells) {
    // 200 samples scattered so thinly that cells of their range hold one each.
    Mixture<3> samples;
    for (int i = 0; i < 200; ++i) {
        Gaussian<3> s;
        s.support = 1;
        s.mean << 5.0, 0.7 * (i % 20) - 7, 0.7 * (i / 20) - 3.5;
        s.covariance = 1e-4 * Eigen::Matrix3d::Identity();
        samples.pushBack(s);
    }
    CellParams one;
    one.minSamples = 1;
    const auto fine = initialiseFromCells(samples, Eigen::Vector3d::Zero(), one).mixture;
    const auto coarse = initialiseFromCells(samples, Eigen::Vector3d::Zero(), {}).mixture;
    EXPECT_GT(fine.size(), 150U);
    EXPECT_LT(coarse.size(), fine.size() / 3);
}

TEST(Cells, NothingGivesNothing) {
    const InitialMixture initial = initialiseFromCells({}, Eigen::Vector3d::Zero(), {});
    EXPECT_TRUE(initial.mixture.empty());
    EXPECT_EQ(initial.neighbourhoods.begin.size(), 1U);
}

TEST(Cells, ParametersOutOfRangeAreNamed) {
    CellParams params;
    params.minSamples = 0;
    EXPECT_THROW(params.validate(), std::invalid_argument);
    params = {};
    params.cellAtOneMetre_m = -1;
    EXPECT_THROW(params.validate(), std::invalid_argument);
}

}  // namespace
}  // namespace hgmm
