#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <set>
#include <string>
#include <tuple>

#include "hgmm/scan.h"

namespace hgmm {
namespace {

constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
constexpr float kInf = std::numeric_limits<float>::infinity();

MapParams withRanges(double minRange_m, double maxRange_m) {
    MapParams params;
    params.filter.minRange_m = minRange_m;
    params.filter.maxRange_m = maxRange_m;
    return params;
}

Eigen::Vector3f endOf(const ClearedRay& ray) {
    return ray.length_m * ray.direction;
}

TEST(ClearedRays, PointsBeyondTheLimitAreCutAtIt) {
    Scan scan;
    scan.pushBack(3, 0, 0);       // a hit
    scan.pushBack(0, 8, 0);       // cut
    scan.pushBack(0, -6, -8);     // cut
    scan.pushBack(0, 0, 0.4F);    // too near
    scan.pushBack(1e30F, 0, 0);   // cut, though its square is no float
    scan.pushBack(kInf, 0, 0);    // no direction to trust
    scan.pushBack(0, kNan, 800);  // the same
    const ScanSamples samples = samplesOf(scan, withRanges(0.5, 5));
    EXPECT_EQ(samples.points.used, 1U);
    EXPECT_EQ(samples.points.cut, 3U);
    EXPECT_EQ(samples.points.tooNear, 1U);
    EXPECT_EQ(samples.points.notFinite, 2U);
    ASSERT_EQ(samples.samples_sensor.size(), 1U);
    EXPECT_FLOAT_EQ(samples.samples_sensor.mean[0][0], 3.F);
    const std::vector<ClearedRay>& rays = samples.clearedRays_sensor;
    ASSERT_EQ(rays.size(), 3U);
    EXPECT_LT((endOf(rays[0]) - Eigen::Vector3f(0, 5, 0)).norm(), 1e-5F);
    EXPECT_LT((endOf(rays[1]) - Eigen::Vector3f(0, -3, -4)).norm(), 1e-5F);
    EXPECT_LT((endOf(rays[2]) - Eigen::Vector3f(5, 0, 0)).norm(), 1e-5F);
}

TEST(ClearedRays, OwnRaysOfAScanKeepTheirLengthUpToTheLimit) {
    Scan scan;
    scan.clearedRays = {{Eigen::Vector3f::UnitX(), 2.F},
                        {Eigen::Vector3f::UnitY(), 50.F},
                        {Eigen::Vector3f::UnitZ(), 0.49F},  // shorter than minRange_m
                        {-Eigen::Vector3f::UnitZ(), 0.F},
                        {1.0005F * -Eigen::Vector3f::UnitX(), 4.F}};
    const auto rays = samplesOf(scan, withRanges(0.5, 5)).clearedRays_sensor;
    ASSERT_EQ(rays.size(), 3U);
    EXPECT_EQ(rays[0].length_m, 2.F);
    EXPECT_EQ(rays[1].length_m, 5.F);
    EXPECT_EQ(rays[2].length_m, 4.F);
    for (const ClearedRay& ray : rays) EXPECT_NEAR(ray.direction.norm(), 1.F, 1e-6F);
    EXPECT_EQ(rays[1].direction, Eigen::Vector3f::UnitY().eval());
    EXPECT_TRUE(samplesOf(scan, withRanges(0, 0)).clearedRays_sensor.empty());
}

TEST(ClearedRays, OneIsLeftForEachLeafOfTheirEnds) {
    // A camera that sees nothing: 10^5 rays through pixels 6 mm apart at 5 m, beyond a
    // limit at which leaves have an edge of 2^-4 m (0.04 sqrt(5) = 0.089).
    constexpr double edge = 0.0625;
    const MapParams params = withRanges(0.1, 5);
    Scan scan;
    std::set<std::tuple<int, int, int>> leaves;
    for (int row = -125; row < 125; ++row)
        for (int col = -200; col < 200; ++col) {
            const Eigen::Vector3d ray =
                Eigen::Vector3d(1, 0.0012 * col + 3e-4, 0.0012 * row + 3e-4).normalized();
            const Eigen::Vector3f point = (20 * ray).cast<float>();
            scan.pushBack(point.x(), point.y(), point.z());
            const Eigen::Vector3d leaf = (5 * ray / edge).array().floor();
            leaves.emplace(int(leaf.x()), int(leaf.y()), int(leaf.z()));
        }
    const auto rays = samplesOf(scan, params).clearedRays_sensor;
    // Rounding may move an end over a leaf's face.
    EXPECT_NEAR(double(rays.size()), double(leaves.size()), 0.01 * double(leaves.size()));
    EXPECT_LT(rays.size(), 2500U);
    // Every ray has one beside it that stayed.
    for (std::size_t i = 0; i < scan.size(); i += 997) {
        const Eigen::Vector3f end =
            Eigen::Vector3f(scan.x[i], scan.y[i], scan.z[i]).normalized() * 5.F;
        float nearest = kInf;
        for (const ClearedRay& ray : rays)
            nearest = std::min(nearest, (endOf(ray) - end).norm());
        EXPECT_LT(nearest, std::sqrt(3.0) * edge + 1e-4);
    }
}

TEST(ClearedRays, LeaveSamplesAsTheyAre) {
    Scan scan;
    for (int i = 0; i < 400; ++i)
        scan.pushBack(4, 0.05F * float(i % 20), 0.05F * float(i / 20));
    const ScanSamples hitsOnly = samplesOf(scan, {});
    EXPECT_TRUE(hitsOnly.clearedRays_sensor.empty());
    for (int i = 0; i < 100; ++i)
        scan.clearedRays.push_back(
            {Eigen::Vector3f(-1, 0.02F * float(i), 0).normalized(), 9.F});
    const ScanSamples both = samplesOf(scan, {});
    EXPECT_EQ(both.samples_sensor, hitsOnly.samples_sensor);
    EXPECT_EQ(both.normalOfRays_sensor, hitsOnly.normalOfRays_sensor);
    EXPECT_EQ(both.points.used, scan.size());
}

/// The few hits of a sensor in the open may lie in a plane by chance, or on a line.
TEST(ClearedRays, TellTheShapeOfTheSensor) {
    Scan pole;  // hits at one azimuth
    for (int i = -5; i <= 5; ++i) pole.pushBack(4, 0, 0.4F * float(i));
    ASSERT_GT(std::abs(samplesOf(pole, {}).normalOfRays_sensor.y()), 0.99);
    Scan planar;
    planar.pushBack(4, 0, 0);
    ASSERT_TRUE(samplesOf(planar, {}).normalOfRays_sensor.isZero());
    for (int i = 0; i < 60; ++i) {
        const float angle = 0.1F * float(i);
        const Eigen::Vector3f ray(std::cos(angle), std::sin(angle), 0);
        planar.clearedRays.push_back({ray, 5.F});
        pole.clearedRays.push_back({ray, 5.F});
    }
    EXPECT_TRUE(samplesOf(pole, {}).normalOfRays_sensor.isZero());
    EXPECT_GT(std::abs(samplesOf(planar, {}).normalOfRays_sensor.z()), 1 - 1e-6);
    planar.x.clear();
    planar.y.clear();
    planar.z.clear();
    EXPECT_GT(std::abs(samplesOf(planar, {}).normalOfRays_sensor.z()), 1 - 1e-6);
}

TEST(ClearedRays, UnsoundOnesAreRefusedByName) {
    const Eigen::Vector3f x = Eigen::Vector3f::UnitX();
    for (const ClearedRay& bad :
         {ClearedRay{0.998F * x, 1.F}, ClearedRay{1.002F * x, 1.F}, ClearedRay{0 * x, 1.F},
          ClearedRay{kNan * x, 1.F}, ClearedRay{kInf * x, 1.F}, ClearedRay{x, -1e-3F},
          ClearedRay{x, kNan}, ClearedRay{x, kInf}}) {
        Scan scan;
        scan.clearedRays = {{x, 0.F}, bad};
        try {
            scan.validate();
            FAIL() << bad.direction.transpose() << ", " << bad.length_m;
        } catch (const std::invalid_argument& e) {
            EXPECT_NE(std::string(e.what()).find("cleared ray 1"), std::string::npos);
        }
    }
}

}  // namespace
}  // namespace hgmm
