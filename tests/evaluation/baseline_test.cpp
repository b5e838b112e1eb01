#include "hgmm/evaluation/baseline.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <stdexcept>

#include "hgmm/evaluation/figures.h"

using namespace hgmm::evaluation;

namespace {

constexpr double kWall_m = 3.03;  // x of the wall in the map frame, amid a voxel of 10 cm

/// A wall of 2 x 2 m, seen from (1.03, 0.53, 0.73) by a sensor that is turned by 90
/// degrees.
hgmm::Scan wallScan() {
    hgmm::Scan scan;
    scan.T_map_sensor.R << 0, -1, 0, 1, 0, 0, 0, 0, 1;
    scan.T_map_sensor.t << 1.03, 0.53, 0.73;
    for (int i = -50; i <= 50; ++i)
        for (int j = -50; j <= 50; ++j) {
            const Eigen::Vector3d p_map(kWall_m, 0.53 + 0.02 * i, 0.73 + 0.02 * j);
            const Eigen::Vector3f p_sensor =
                (scan.T_map_sensor.R.transpose() * (p_map - scan.T_map_sensor.t))
                    .cast<float>();
            scan.pushBack(p_sensor.x(), p_sensor.y(), p_sensor.z());
        }
    return scan;
}

Answer ask(const Baseline& map, double x, double y = 0.53, double z = 0.73) {
    const Eigen::Vector3d p(x, y, z);
    Answer answer;
    map.query(&p, 1, &answer);
    return answer;
}

}  // namespace

TEST(OctomapBaseline, AWallSeenFromOnePlace) {
    const auto map = makeBaseline("octomap:0.1");
    EXPECT_TRUE(ask(*map, kWall_m).unknown) << "nothing was seen yet";
    map->insert(wallScan());
    // OctoMap's defaults: 0.7 for one hit, 0.4 for one miss, of a voxel once a scan,
    // however many of the rays cross it.
    EXPECT_FALSE(ask(*map, kWall_m).unknown);
    EXPECT_NEAR(ask(*map, kWall_m).probability, 0.7, 1e-6);
    EXPECT_NEAR(ask(*map, kWall_m, 1.0, 0.3).probability, 0.7, 1e-6);
    for (double x = 1.03; x < 2.9; x += 0.1)
        EXPECT_NEAR(ask(*map, x).probability, 0.4, 1e-6) << x;
    // Behind the wall, behind the sensor, beside the rays: unknown.
    for (const Answer& answer : {ask(*map, kWall_m + 0.1), ask(*map, 0.93),
                                 ask(*map, 1.2, 1.2), ask(*map, 1.0e6)}) {
        EXPECT_TRUE(answer.unknown);
        EXPECT_EQ(answer.probability, 0.5);
    }
    map->insert(wallScan());
    const double odds = 0.7 / 0.3 * 0.7 / 0.3;
    EXPECT_NEAR(ask(*map, kWall_m).probability, odds / (1 + odds), 1e-6);
}

TEST(OctomapBaseline, IsPrunedAndCountsItsMemory) {
    const auto fine = makeBaseline("octomap:0.1"), coarse = makeBaseline("octomap:0.2");
    const std::size_t empty = fine->liveBytes();
    fine->insert(wallScan());
    coarse->insert(wallScan());
    EXPECT_GT(fine->liveBytes(), empty);
    EXPECT_GT(fine->liveBytes(), 2 * coarse->liveBytes());
    std::size_t known = 0;
    for (double x = 1.05; x < 3.2; x += 0.1)
        for (double y = -0.55; y < 1.7; y += 0.1)
            for (double z = -0.35; z < 1.9; z += 0.1)
                known += ask(*fine, x, y, z).unknown ? 0 : 1;
    // A pyramid of 2.7 m^3. Unpruned, each voxel has a node and a pointer to it.
    EXPECT_GT(known, 2600U);
    EXPECT_LT(fine->liveBytes(), known * (2 * sizeof(void*) + sizeof(void*)));
}

TEST(OctomapBaseline, PointsThatAreNotFiniteAreLeftOut) {
    const auto clean = makeBaseline("octomap:0.1"), dirty = makeBaseline("octomap:0.1");
    hgmm::Scan scan = wallScan();
    clean->insert(scan);
    scan.pushBack(std::nanf(""), 0, 0);
    scan.pushBack(0, std::numeric_limits<float>::infinity(), 0);
    dirty->insert(scan);
    EXPECT_EQ(clean->liveBytes(), dirty->liveBytes());
    EXPECT_TRUE(ask(*dirty, std::nan("")).unknown);
}

TEST(Baseline, IsMadeByNameAndResolution) {
    const auto map = makeBaseline("octomap:0.25");
    EXPECT_EQ(map->className(), "mrpt::maps::COctoMap");
    ASSERT_FALSE(map->options().empty());
    EXPECT_EQ(map->options()[0].first, "resolution");
    EXPECT_DOUBLE_EQ(map->options()[0].second, 0.25);
    for (const char* wrong : {"", "octomap", "octomap:", "octomap:0", "octomap:-1",
                              "octomap:nan", "octomap:x", "octomap:0.1 0.2", "grid:0.1"})
        EXPECT_THROW(makeBaseline(wrong), std::invalid_argument) << wrong;
}

TEST(Baseline, IsScoredByTheSameCode) {
    const auto map = makeBaseline("octomap:0.1");
    map->insert(wallScan());
    TestPoints points(1, {0.1, 0.6}, {});
    points.add(wallScan(), 0);
    const MapFigures figures = evaluateBaseline(*map, points);
    EXPECT_EQ(figures.className, "mrpt::maps::COctoMap");
    EXPECT_FALSE(figures.memory.serialized_bytes);
    EXPECT_EQ(figures.memory.live_bytes, map->liveBytes());
    EXPECT_TRUE(figures.levels.empty());
    ASSERT_TRUE(figures.occupancy);
    EXPECT_EQ(figures.occupancy->aucUniform, 1.0);
    EXPECT_EQ(figures.occupancy->unknownShareHit, 0.0);
    EXPECT_NEAR(figures.occupancy->brier, (0.3 * 0.3 + 0.4 * 0.4) / 2, 0.01);
}
