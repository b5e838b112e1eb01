#include "hgmm/evaluation/baseline.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <stdexcept>
#include <string>
#include <tuple>

#include "hgmm/evaluation/figures.h"
#include "wall_scene.h"

using namespace hgmm::evaluation;
using namespace wall_scene;

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
    for (const char* wrong :
         {"", "octomap:", "octomap:0", "octomap:-1", "octomap:nan", "octomap:x",
          "octomap:0.1 0.2", "grid:0.1", "nn:0.1", "ndt:", "ndt-om:inf", "grid3d:0"})
        EXPECT_THROW(makeBaseline(wrong), std::invalid_argument) << wrong;
}

TEST(Baseline, ResolutionsGoByTheSensor) {
    for (const auto& [name, depthCamera_m, lidar_m] :
         {std::tuple("octomap", 0.05, 0.3), std::tuple("grid3d", 0.05, 0.3),
          std::tuple("ndt", 0.1, 0.4), std::tuple("ndt-om", 0.1, 0.4),
          std::tuple("gpoctomap", 0.05, 0.3),
          std::tuple("gpoctomap-published", 0.05, 0.3)}) {
        const auto near = makeBaseline(name), far = makeBaseline(name, SensorKind::lidar);
        EXPECT_EQ(near->options().at(0).first, "resolution") << name;
        EXPECT_DOUBLE_EQ(near->options().at(0).second, depthCamera_m) << name;
        EXPECT_DOUBLE_EQ(far->options().at(0).second, lidar_m) << name;
    }
}

TEST(Baseline, PublishedSettingsAreNotTheDefaults) {
    const auto valueOf = [](const Baseline& map, const std::string& option) {
        for (const auto& [name, value] : map.options())
            if (name == option) return value;
        return -1.0;
    };
    const auto ours = makeBaseline("gpoctomap:0.1");
    const auto published = makeBaseline("gpoctomap-published:0.1");
    EXPECT_DOUBLE_EQ(valueOf(*published, "resolution"), 0.1);
    EXPECT_DOUBLE_EQ(valueOf(*published, "mergeProbability"), 0.7);
    EXPECT_DOUBLE_EQ(valueOf(*published, "minVariance"), 1e-3);
    EXPECT_DOUBLE_EQ(valueOf(*published, "sampleSpacing"), 0.1);
    EXPECT_DOUBLE_EQ(valueOf(*ours, "sampleSpacing"), 0.2);
}

TEST(Baseline, AllAreNamedInTheErrorAndCanBeMade) {
    std::string message;
    try {
        makeBaseline("voxels");
    } catch (const std::invalid_argument& error) {
        message = error.what();
    }
    EXPECT_NE(message.find("voxels"), std::string::npos);
    ASSERT_EQ(baselineNames().size(), 7U);
    for (const auto& [name, line] : baselineNames()) {
        EXPECT_NE(message.find(name), std::string::npos) << name;
        EXPECT_FALSE(line.empty()) << name;
        EXPECT_FALSE(makeBaseline(name)->source().empty()) << name;
    }
}

TEST(Baseline, AnyMapBearsEmptyAndHostileInput) {
    for (const auto& entry : baselineNames()) {
        const auto clean = makeBaseline(entry.first), dirty = makeBaseline(entry.first);
        dirty->insert(hgmm::Scan{});
        hgmm::Scan nothing;
        addHostilePoints(nothing);
        dirty->insert(nothing);
        EXPECT_TRUE(ask(*dirty, 0.0).unknown) << entry.first;
        hgmm::Scan scan = rays(20);
        addPoint(scan, origin_map());  // a range of zero
        clean->insert(scan);
        addHostilePoints(scan);
        dirty->insert(scan);
        EXPECT_EQ(clean->liveBytes(), dirty->liveBytes()) << entry.first;
        for (const double x : {1.03, 2.0, 2.9, 3.03, 3.1, 1e6, -1e300, std::nan("")}) {
            const Answer answer = ask(*dirty, x);
            EXPECT_EQ(answer.probability, ask(*clean, x).probability) << entry.first << x;
            EXPECT_GE(answer.probability, 0.0) << entry.first << x;
            EXPECT_LE(answer.probability, 1.0) << entry.first << x;
        }
        EXPECT_TRUE(ask(*dirty, std::nan("")).unknown) << entry.first;
    }
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
