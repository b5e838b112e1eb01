#include "hgmm/scan.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <map>
#include <tuple>

#include "room_scanner.h"

namespace hgmm {
namespace {

using testing::poseAt;
using testing::RoomScanner;

/// Noise so small that a sample's covariance is its scatter.
FilterParams nearlyNoiseless() {
    FilterParams params;
    params.noiseStd_m = 1e-4;
    params.noisePerRange = 0;
    return params;
}

TEST(Filter, AgreesWithADirectGrouping) {
    const Scan scan = RoomScanner().scan(poseAt(0.5, 0.2, 1.1, 0.3), 7);
    const FilterParams params = nearlyNoiseless();
    std::map<std::tuple<int, long, long, long>, std::vector<Eigen::Vector3d>> leaves;
    for (std::size_t i = 0; i < scan.size(); ++i) {
        const Eigen::Vector3f p(scan.x[i], scan.y[i], scan.z[i]);
        const float range = std::sqrt(p.x() * p.x() + p.y() * p.y() + p.z() * p.z());
        const int octave = std::ilogb(std::max(
            float(params.minLeaf_m), float(params.resolution_m) * std::sqrt(range)));
        const double edge = std::ldexp(1.0, octave);
        leaves[{octave, std::lround(std::floor(p.x() / edge)),
                std::lround(std::floor(p.y() / edge)),
                std::lround(std::floor(p.z() / edge))}]
            .push_back(p.cast<double>());
    }
    FilterCounts counts;
    const Mixture<3> samples = filterScan(scan, params, &counts);
    EXPECT_EQ(counts.used, scan.size());
    ASSERT_EQ(samples.size(), leaves.size());
    EXPECT_LT(samples.size(), scan.size());

    std::map<std::tuple<float, float, float>, std::size_t> byMean;
    for (std::size_t i = 0; i < samples.size(); ++i)
        byMean[{samples.mean[0][i], samples.mean[1][i], samples.mean[2][i]}] = i;
    ASSERT_EQ(byMean.size(), samples.size());
    double support = 0;
    for (const auto& [key, points] : leaves) {
        Eigen::Vector3d mean = Eigen::Vector3d::Zero();
        Eigen::Matrix3d outer = Eigen::Matrix3d::Zero();
        for (const auto& p : points) mean += p / double(points.size());
        for (const auto& p : points)
            outer += (p - mean) * (p - mean).transpose() / double(points.size());
        bool found = false;
        for (std::size_t i = 0; i < samples.size() && !found; ++i) {
            const Gaussian<3> s = samples[i];
            if ((s.mean - mean).norm() > 1e-5 || s.support != double(points.size()))
                continue;
            found =
                (s.covariance - outer - 1e-8 * Eigen::Matrix3d::Identity()).norm() < 1e-7;
        }
        EXPECT_TRUE(found);
        support += double(points.size());
    }
    EXPECT_EQ(samples.totalSupport(), support);
}

TEST(Filter, LeavesGrowWithTheRootOfTheRange) {
    Scan scan;
    for (const float range : {1.F, 100.F})
        for (int i = 0; i < 1000; ++i)
            scan.pushBack(range, std::sqrt(range) * 0.4F * float(i) / 1000.F, 0.F);
    const Mixture<3> samples = filterScan(scan, {});
    std::size_t near = 0, far = 0;
    for (const float x : samples.mean[0]) ++(x < 50.F ? near : far);
    EXPECT_NEAR(double(near), double(far),
                0.5 * double(near));  // octaves: up to a factor of 2
    EXPECT_GT(far, 10U);
}

TEST(Filter, CountsAndDropsWhatIsNoMeasurement) {
    const float nan = std::numeric_limits<float>::quiet_NaN();
    const float inf = std::numeric_limits<float>::infinity();
    Scan scan;
    scan.pushBack(nan, 0, 0);
    scan.pushBack(1, inf, 0);
    scan.pushBack(1, 0, -inf);
    scan.pushBack(0, 0, 0);
    scan.pushBack(1e6F, 0, 0);
    scan.pushBack(1e30F, 1e30F, 0);
    scan.pushBack(2, 0, 0);
    FilterCounts counts;
    const Mixture<3> samples = filterScan(scan, {}, &counts);
    samples.check();
    EXPECT_EQ(samples.size(), 1U);
    EXPECT_EQ(counts.notFinite, 3U);
    EXPECT_EQ(counts.tooNear, 1U);
    EXPECT_EQ(counts.cut, 2U);
    EXPECT_EQ(counts.used, 1U);
}

TEST(Filter, ASinglePointIsAGaussianOfTheSensorsNoise) {
    Scan scan;
    scan.pushBack(0, 10, 0);
    FilterParams params;
    params.noiseStd_m = 0.01;
    params.noisePerRange = 0.002;
    const Gaussian<3> sample = filterScan(scan, params)[0];
    EXPECT_TRUE(
        sample.covariance.isApprox(0.03 * 0.03 * Eigen::Matrix3d::Identity(), 1e-5));
}

TEST(Filter, DegenerateClustersStayPositiveDefinite) {
    for (const int kind : {0, 1, 2}) {  // identical, on a line, on a plane
        Scan scan;
        for (int i = 0; i < 1000; ++i) {
            const float a = kind >= 1 ? 0.001F * float(i % 31) : 0.F;
            const float b = kind >= 2 ? 0.001F * float(i / 31) : 0.F;
            scan.pushBack(3.F + a, 1.F + b, 2.F);
        }
        const Mixture<3> samples = filterScan(scan, {});
        samples.check();
        EXPECT_EQ(samples.totalSupport(), 1000.0);
    }
}

TEST(Filter, ParametersOutOfRangeAreNamed) {
    FilterParams params;
    params.resolution_m = std::numeric_limits<double>::quiet_NaN();
    try {
        params.validate();
        FAIL() << "accepted NaN";
    } catch (const std::invalid_argument& e) {
        EXPECT_NE(std::string(e.what()).find("resolution_m"), std::string::npos);
    }
    params = {};
    params.maxRange_m = params.minRange_m / 2;
    EXPECT_THROW(params.validate(), std::invalid_argument);
    params = {};
    params.noiseStd_m = 0;
    EXPECT_THROW(params.validate(), std::invalid_argument);
    FilterParams().validate();
}

TEST(Transformed, MovesMeansAndTurnsCovariances) {
    Gaussian<3> g;
    g.support = 5;
    g.mean << 1, 2, 3;
    g.covariance.diagonal() << 1.0, 0.04, 0.01;
    Mixture<3> mixture;
    mixture.pushBack(g);
    const Gaussian<3> moved = transformed(mixture, poseAt(10, 20, 30, M_PI / 2))[0];
    EXPECT_TRUE(moved.mean.isApprox(Eigen::Vector3d(8, 21, 33), 1e-6));
    EXPECT_NEAR(moved.covariance(0, 0), 0.04, 1e-6);
    EXPECT_NEAR(moved.covariance(1, 1), 1.0, 1e-6);
    EXPECT_NEAR(moved.covariance(2, 2), 0.01, 1e-6);
    EXPECT_EQ(moved.support, 5);
}

}  // namespace
}  // namespace hgmm
