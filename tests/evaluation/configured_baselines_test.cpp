#include "hgmm/evaluation/configured_baselines.h"

#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <map>
#include <stdexcept>

#include "scratch_folder.h"
#include "wall_scene.h"

using namespace hgmm::evaluation;
using namespace wall_scene;

namespace {

/// The scan's sensor is off the origin and turned: a lost pose shows.
class ConfiguredBaselines : public ScratchFolder {
 protected:
    std::map<std::string, std::unique_ptr<Baseline>> load(const std::string& text) {
        std::ofstream(path("maps.ini")) << text;
        std::map<std::string, std::unique_ptr<Baseline>> maps;
        for (auto& [name, map] : configuredBaselines(path("maps.ini"))) {
            map->insert(hgmm::Scan{});
            map->insert(wallScan());
            maps[name] = std::move(map);
        }
        return maps;
    }
};

}  // namespace

TEST_F(ConfiguredBaselines, VoxelsAnswerWithOccupancy) {
    const auto maps = load(R"([map]
octoMap_count = 2
colourOctoMap_count = 1
mrpt::maps::COccupancyGridMap3D_count = 1
[map_octoMap_00_creationOpts]
resolution = 0.1
[map_octoMap_01_creationOpts]
resolution = 0.2
[map_octoMap_01_insertOpts]
probHit = 0.9
[map_colourOctoMap_00_creationOpts]
resolution = 0.1
[map_mrpt::maps::COccupancyGridMap3D_00_creationOpts]
min_x = 0
max_x = 4
min_y = -2
max_y = 2
min_z = -2
max_z = 2
resolution = 0.1
)");
    ASSERT_EQ(maps.size(), 4U);
    const auto own = makeBaseline("octomap:0.1");
    own->insert(wallScan());
    for (const double x : {1.03, 2.03, 2.93, kWall_m, 3.13, 0.93}) {
        EXPECT_EQ(ask(*maps.at("octoMap_00"), x).probability, ask(*own, x).probability)
            << x;
        EXPECT_EQ(ask(*maps.at("octoMap_00"), x).unknown, ask(*own, x).unknown) << x;
    }
    EXPECT_NEAR(ask(*maps.at("octoMap_01"), kWall_m).probability, 0.9, 1e-6);
    EXPECT_DOUBLE_EQ(maps.at("octoMap_01")->options().at(0).second, 0.2);
    for (const auto& [name, map] : maps) {
        EXPECT_EQ(map->meaning(), Meaning::occupancy) << name;
        EXPECT_GT(ask(*map, kWall_m).probability, 0.6) << name;
        EXPECT_LT(ask(*map, 2.0).probability, 0.45) << name;
        EXPECT_TRUE(ask(*map, kWall_m + 0.4).unknown) << name;
        EXPECT_EQ(ask(*map, std::nan("")).probability, 0.5) << name;
        EXPECT_GT(map->liveBytes(), 1000U) << name;
        EXPECT_GT(map->serializedBytes().value(), 100U) << name;
    }
    // The grid has the size of its file.
    const std::string grid = "mrpt::maps::COccupancyGridMap3D_00";
    EXPECT_EQ(maps.at(grid)->liveBytes(), 40U * 40U * 40U);
    EXPECT_EQ(maps.at(grid)->className(), "mrpt::maps::COccupancyGridMap3D");
}

TEST_F(ConfiguredBaselines, PointsAnswerWithNearness) {
    const auto maps = load(R"([map]
pointsMap_count = 1
weightedPointsMap_count = 1
colourPointsMap_count = 1
[map_pointsMap_00_insertOpts]
minDistBetweenLaserPoints = 0
)");
    ASSERT_EQ(maps.size(), 3U);
    for (const auto& [name, map] : maps) {
        EXPECT_EQ(map->meaning(), Meaning::nearness) << name;
        EXPECT_NEAR(ask(*map, kWall_m).probability, 1.0, 1e-4) << name;
        EXPECT_NEAR(ask(*map, kWall_m - 0.1).probability, 0.5, 1e-4) << name;
        EXPECT_TRUE(ask(*map, std::nan("")).unknown) << name;
        EXPECT_GT(map->liveBytes(), 1000U) << name;
    }
}

TEST_F(ConfiguredBaselines, OthersAnswerWithLikelihoodOrNotAtAll) {
    const auto maps = load(R"([map]
occupancyGrid_count = 1
heightMap_count = 1
reflectivityMap_count = 1
)");
    ASSERT_EQ(maps.size(), 3U);
    for (const auto& [name, map] : maps) {
        EXPECT_EQ(map->meaning(), Meaning::surfaceLikelihood) << name;
        for (const double x : {1.0, 2.0, kWall_m, 1e6, std::nan("")}) {
            EXPECT_GE(ask(*map, x).probability, 0.0) << name;
            EXPECT_LE(ask(*map, x).probability, 1.0) << name;
        }
    }
}

TEST_F(ConfiguredBaselines, OwnMapsAreLeftOut) {
    EXPECT_TRUE(load("[map]\nhgmmMap_count = 1\n").empty());
    EXPECT_TRUE(load("").empty());
    EXPECT_TRUE(load("[other]\nparticle_count = 7\nmaps_count = 1\n_count = 3\n").empty());
    EXPECT_TRUE(load("[map]\noctoMap_count = 0\n").empty());
}

TEST_F(ConfiguredBaselines, SectionsAreToldApart) {
    const auto maps = load(
        "[a]\noctoMap_count = 1\n[b]\noctoMap_count = 1\n"
        "pointsMap_count = 1\n");
    EXPECT_EQ(maps.size(), 3U);
    for (const char* name : {"a/octoMap_00", "b/octoMap_00", "pointsMap_00"})
        EXPECT_EQ(maps.count(name), 1U) << name;
}

TEST_F(ConfiguredBaselines, InsertionCanBeTurnedOff) {
    for (const char* kind :
         {"octoMap", "colourOctoMap", "COccupancyGridMap3D", "pointsMap"}) {
        const std::string name = kind;
        const auto maps = load("[map]\n" + name + "_count = 1\n[map_" + name +
                               "_00_creationOpts]\nenableObservationInsertion = false\n");
        ASSERT_EQ(maps.size(), 1U) << name;
        EXPECT_TRUE(ask(*maps.at(name + "_00"), kWall_m).unknown) << name;
    }
}

TEST_F(ConfiguredBaselines, MapsThatCannotBeMadeAreSaidInALine) {
    try {
        load("[map]\ngasGrid_count = 1\n");  // whose sensor's label is missing
        ADD_FAILURE();
    } catch (const std::runtime_error& error) {
        const std::string what = error.what();
        EXPECT_NE(what.find(path("maps.ini")), std::string::npos) << what;
        EXPECT_NE(what.find("gasSensorLabel"), std::string::npos) << what;
        EXPECT_EQ(what.find('\n'), std::string::npos) << what;
    }
}

TEST_F(ConfiguredBaselines, ErrorsNameTheFile) {
    for (const std::string& file : {path("missing.ini"), path("")}) {
        try {
            configuredBaselines(file);
            ADD_FAILURE() << file;
        } catch (const std::runtime_error& error) {
            EXPECT_NE(std::string(error.what()).find(file), std::string::npos);
        }
    }
}
