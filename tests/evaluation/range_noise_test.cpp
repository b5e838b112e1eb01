#include "hgmm/evaluation/range_noise.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <stdexcept>

using hgmm::Scan;
using hgmm::evaluation::addRangeNoise;

namespace {

Scan sphere(std::size_t n, double range_m) {
    Scan scan;
    for (std::size_t i = 0; i < n; ++i) {
        const double z = 1.0 - 2.0 * (double(i) + 0.5) / double(n);
        const double angle = 2.4 * double(i), r = std::sqrt(1 - z * z);
        scan.pushBack(float(range_m * r * std::cos(angle)),
                      float(range_m * r * std::sin(angle)), float(range_m * z));
    }
    return scan;
}

Eigen::Vector3d pointOf(const Scan& scan, std::size_t i) {
    return {scan.x[i], scan.y[i], scan.z[i]};
}

}  // namespace

TEST(RangeNoise, IsNormalAlongTheRayAndNothingBeside) {
    const std::size_t n = 20000;
    const Scan exact = sphere(n, 5.0);
    Scan noisy = exact;
    addRangeNoise(noisy, 0.02, 1, 0);
    double sum = 0, squares = 0, fourth = 0;
    for (std::size_t i = 0; i < n; ++i) {
        const Eigen::Vector3d u = pointOf(exact, i).normalized();
        const double along = u.dot(pointOf(noisy, i)) - 5.0;
        EXPECT_NEAR((pointOf(noisy, i) - (5.0 + along) * u).norm(), 0.0, 1e-5);
        sum += along;
        squares += along * along;
        fourth += std::pow(along, 4);
    }
    const double variance = squares / double(n);
    EXPECT_NEAR(sum / double(n), 0.0, 4 * 0.02 / std::sqrt(double(n)));
    EXPECT_NEAR(std::sqrt(variance), 0.02, 0.0005);
    EXPECT_NEAR(fourth / double(n) / (variance * variance), 3.0, 0.2) << "kurtosis";
}

TEST(RangeNoise, FollowsSeedAndScanOnly) {
    Scan a = sphere(50, 3.0), b = a, otherSeed = a, otherScan = a, none = a;
    addRangeNoise(a, 0.1, 7, 3);
    addRangeNoise(b, 0.1, 7, 3);
    addRangeNoise(otherSeed, 0.1, 8, 3);
    addRangeNoise(otherScan, 0.1, 7, 4);
    addRangeNoise(none, 0.0, 7, 3);
    EXPECT_EQ(a.x, b.x);
    EXPECT_NE(a.x, otherSeed.x);
    EXPECT_NE(a.x, otherScan.x);
    EXPECT_EQ(none.x, sphere(50, 3.0).x);
}

TEST(RangeNoise, HostilePointsStayAndBadDeviationsAreRefused) {
    Scan scan;
    const float nan = std::numeric_limits<float>::quiet_NaN();
    const float infinity = std::numeric_limits<float>::infinity();
    scan.pushBack(0, 0, 0);
    scan.pushBack(nan, 1, 1);
    scan.pushBack(infinity, 0, 0);
    scan.pushBack(1, 0, 0);
    addRangeNoise(scan, 0.1, 1, 0);
    EXPECT_EQ(pointOf(scan, 0), Eigen::Vector3d(0, 0, 0));
    EXPECT_TRUE(std::isnan(scan.x[1]));
    EXPECT_EQ(scan.y[1], 1.F);
    EXPECT_EQ(scan.x[2], infinity);
    EXPECT_NE(scan.x[3], 1.F);
    EXPECT_THROW(addRangeNoise(scan, -0.1, 1, 0), std::invalid_argument);
    EXPECT_THROW(addRangeNoise(scan, nan, 1, 0), std::invalid_argument);
}
