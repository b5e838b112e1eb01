// Scans of far more points, or of other scales, than sensors have.
#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/time.h>

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <random>
#include <string>
#include <vector>

#include "hgmm/map.h"
#include "modality/channel_samples.h"
#include "scan/cleared_rays.h"

namespace hgmm {
namespace {

/// Points evenly in a cube around the sensor: few share a leaf.
Scan cubeOfPoints(std::size_t points, double edge_m) {
    std::mt19937 engine(1);
    std::uniform_real_distribution<float> along(float(-edge_m / 2), float(edge_m / 2));
    Scan scan;
    for (auto* axis : {&scan.x, &scan.y, &scan.z}) {
        axis->reserve(points);
        for (std::size_t i = 0; i < points; ++i) axis->push_back(along(engine));
    }
    return scan;
}

double sum(const std::vector<float>& values) {
    double total = 0;
    for (const float v : values) total += double(v);
    return total;
}

TEST(LargeScan, IsReadInLeavesThatAreFewEnough) {
    const Scan scan = cubeOfPoints(2 * kMaxSamples, 100);
    FilterCounts counts, counted;
    const Mixture<3> samples = filterScan(scan, {}, &counts);
    EXPECT_LE(samples.size(), kMaxSamples);
    EXPECT_GT(samples.size(), kMaxSamples / 16);
    EXPECT_EQ(counts.used + counts.tooNear, scan.size());
    EXPECT_EQ(sum(samples.support), double(counts.used));
    ASSERT_GT(counts.doublings, 0);
    FilterParams coarse;
    coarse.resolution_m = std::ldexp(coarse.resolution_m, counts.doublings);
    coarse.minLeaf_m = std::ldexp(coarse.minLeaf_m, counts.doublings);
    EXPECT_TRUE(samples == filterScan(scan, coarse, &counted));
    EXPECT_EQ(counted.doublings, 0);
}

TEST(LargeScan, HasOneSampleForEachOfAsManyLeavesAsThereMayBe) {
    Scan scan;
    for (std::size_t i = 0; i <= kMaxSamples; ++i)
        scan.pushBack(float(2 + i % 64), float(2 + i / 64 % 64), float(2 + i / 4096));
    FilterParams params;
    params.maxRange_m = 1000;
    FilterCounts counts;
    EXPECT_LT(filterScan(scan, params, &counts).size(), kMaxSamples);
    EXPECT_GT(counts.doublings, 0);
    scan.x.pop_back(), scan.y.pop_back(), scan.z.pop_back();
    EXPECT_EQ(filterScan(scan, params, &counts).size(), kMaxSamples);
    EXPECT_EQ(counts.doublings, 0);
}

TEST(LargeScan, ClearsAlongRaysThatAreFewEnough) {
    const Scan scan = cubeOfPoints(2 * kMaxSamples, 1e5);
    const std::vector<ClearedRay> rays = clearedRaysOf(scan, {});
    EXPECT_LE(rays.size(), kMaxSamples);
    EXPECT_GT(rays.size(), kMaxSamples / 8);
}

TEST(LargeScan, ColoursAreReadInLeavesThatAreFewEnough) {
    const Scan scan = cubeOfPoints(2 * kMaxSamples, 100);
    const Channel grey{"intensity", std::vector<float>(scan.size(), 0.5F)};
    const ChannelSamples samples = filterChannels(scan, {&grey}, {}, {});
    EXPECT_LE(samples.size(), kMaxSamples);
    EXPECT_GT(samples.size(), kMaxSamples / 16);
}

TEST(LargeScan, ScansOfOtherScalesAreAccountedFor) {
    for (const double edge_m : {1e-4, 1e-3, 1e5}) {
        const Scan scan = cubeOfPoints(1000, edge_m);
        Map map;
        const InsertReport report = map.insert(scan);
        EXPECT_TRUE(map.empty()) << edge_m;
        EXPECT_EQ(edge_m > 1 ? report.points.cut : report.points.tooNear, scan.size());
        const Occupancy o = map.occupancy(Eigen::Vector3d(1, 2, 3));
        EXPECT_NEAR(double(o.occupied + o.free + o.unknown), 1, 1e-5);
    }
}

/// What the process used so far.
struct Used {
    double time_s;       ///< of all processors
    double mostBytes_B;  ///< resident, at once
    static Used now() {
        rusage used{};
        getrusage(RUSAGE_SELF, &used);
        const auto seconds = [](const timeval& t) {
            return double(t.tv_sec) + 1e-6 * double(t.tv_usec);
        };
        return {seconds(used.ru_utime) + seconds(used.ru_stime),
                1024.0 * double(used.ru_maxrss)};
    }
};

/// HGMM_LARGE_SCAN points, 2000 if unset. From 10^7 on the bounds are asked for; fewer
/// may all be samples, each of which costs more than a point may.
TEST(LargeScan, CostsLittleForEachPoint) {
    const char* said = std::getenv("HGMM_LARGE_SCAN");
    const std::size_t points = said != nullptr ? std::stoul(said) : 2000;
    for (const double edge_m : {100.0, 1e5}) {
        const Scan scan = cubeOfPoints(points, edge_m);
        const Used before = Used::now();
        Map map;
        const InsertReport report = map.insert(scan);
        const Used after = Used::now();
        EXPECT_LE(report.samples, kMaxSamples);
        const double time_us = 1e6 * (after.time_s - before.time_s) / double(points),
                     inputs = (after.mostBytes_B - before.mostBytes_B) /
                              double(3 * sizeof(float) * points);
        std::printf(
            "%zu points in %g m: %zu samples, %.2f us of processors a point, "
            "%.2f times the input in memory\n",
            points, edge_m, report.samples, time_us, inputs);
        if (points < 10'000'000) continue;
        EXPECT_LE(time_us, 2.0);
        EXPECT_LE(inputs, 3.0);
    }
}

}  // namespace
}  // namespace hgmm
