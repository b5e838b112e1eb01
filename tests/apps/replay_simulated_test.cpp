#include "replay_map_fixture.h"

namespace {

/// Studies that simulate their own world.
class ReplaySimulated : public ReplayFolder {
 protected:
    nlohmann::json study(const std::string& arguments) const {
        const Outcome outcome =
            replay("--study " + arguments + " --quiet --report '" + path("report") + "'");
        EXPECT_EQ(outcome.exitCode, 0) << outcome.err;
        return metrics("report");
    }
    static const nlohmann::json& rowOf(const nlohmann::json& table,
                                       const std::string& map) {
        for (const auto& row : table)
            if (row["map"] == map) return row;
        throw std::runtime_error("no row of " + map);
    }
};

}  // namespace

// A grid of voxels frees what one ray passed as often as it was hit: its figures are known
// beforehand.
TEST_F(ReplaySimulated, RemovedBoxIsFreedByVoxelsInTime) {
    const auto json =
        study("dynamics --only removed --sensors 16 --after 2 --baselines octomap:0.1");
    const auto& removed = json["removed"];
    ASSERT_EQ(removed.size(), 2U);
    for (const char* map : {"hgmm", "octomap:0.1"}) {
        const auto row = rowOf(removed, map);
        EXPECT_EQ(row["sensor"], "16");
        EXPECT_EQ(row["after"], "2");
        EXPECT_GT(row["points"], 200) << "of 300 to 500 that hit a box of .6 m";
    }
    const auto voxels = rowOf(removed, "octomap:0.1");
    // Two hits are log-odds of 2 x 0.85; a miss is -0.4: five misses, if one ray passes.
    EXPECT_GE(voxels["scans_to_half"], 4);
    EXPECT_LE(voxels["scans_to_half"], 6);
    for (const auto& row : json["stays"]) EXPECT_GT(row["wall_before"], 0.9);
    EXPECT_FALSE(json.contains("person")) << "--only chooses";
}

TEST_F(ReplaySimulated, AppearsAtOnceInVoxelsThatWereHardlyEverSeen) {
    const auto json =
        study("dynamics --only appears --sensors 16 --after 1 --baselines octomap:0.1");
    const auto voxels = rowOf(json["appears"], "octomap:0.1");
    // One miss is -0.4, one hit is 0.85.
    EXPECT_EQ(voxels["scans_to_half"], 1);
    EXPECT_LE(voxels["scans_to_99pct"], 3);
}

TEST_F(ReplaySimulated, ParkedRobotsMapDoesNotGrowAndHasANewWall) {
    const auto json = study("parked --only dust --sensors 2d --after 2000 --threads 1");
    ASSERT_EQ(json["parked"].size(), 2U) << "noise of 1 and 2 cm";
    for (const auto& row : json["parked"]) {
        EXPECT_GE(row["components_surface_10"], 20) << "a room of 44 m around";
        EXPECT_GT(row["kilobytes_10"], 1.0);
        EXPECT_FALSE(row.contains("components_surface_4000"));
        EXPECT_LE(row["growth"], 1.2);
        EXPECT_LE(row["wall_scans_to_99pct"], 5);
    }
}

// Voxels of 5 cm reach past the margin of 4 cm, so that some are seen at a face.
TEST_F(ReplaySimulated, SolidsAreUnknownToVoxels) {
    const auto json =
        study("unseen --only solids --sensors 2d --after 9 --baselines octomap");
    ASSERT_EQ(json["solids"].size(), 4U) << "two routes, two maps";
    for (const auto& row : json["solids"]) {
        if (row["map"] != "octomap") continue;
        for (const char* figure : {"free_in_box_05", "free_in_box_12", "free_behind_walls",
                                   "free_beyond_corners", "below_half_in_solids"})
            EXPECT_LT(row[figure], 0.01) << figure;
        EXPECT_LT(row["seen_called_unknown"], 0.05);
    }
}

TEST_F(ReplaySimulated, HallIsFreeInTheGridThatUsesInvalidRays) {
    const auto json = study("unseen --only hall");
    ASSERT_EQ(json["hall"].size(), 18U) << "two limits, three flags, three maps";
    for (const auto& row : json["hall"]) {
        const double all = row["passed_free"].get<double>() +
                           row["passed_occupied"].get<double>() +
                           row["passed_unknown"].get<double>();
        EXPECT_NEAR(all, 1.0, 1e-9);
        if (row["map"] != "grid2d" || row["no return is"] != "invalid, max") continue;
        EXPECT_GT(row["passed_free"], 0.7);
    }
}

TEST_F(ReplaySimulated, SeedsGiveTheWorstAndRunsAreReproducible) {
    const std::string command = "dynamics --only appears --sensors 16 --after 3 ";
    const auto worst = study(command + "--seeds 2");
    const auto again = study(command + "--seeds 2 --threads 1");
    const auto first = study(command);
    const auto second = study(command + "--seed 2");
    const char* const key = "occupied_share_1";
    const auto figure = [&](const nlohmann::json& json) {
        return json["appears"][0][key].get<double>();
    };
    EXPECT_EQ(figure(worst), std::min(figure(first), figure(second)));
    EXPECT_EQ(figure(worst), figure(again));
    EXPECT_EQ(worst["stays"], again["stays"]);
}

TEST_F(ReplaySimulated, WhatThereIsNotIsNamed) {
    const Outcome part = replay("--study dynamics --only remved");
    EXPECT_EQ(part.exitCode, 1);
    expectHas(part.err, "--only: remved is none of removed, appears");
    const Outcome sensor = replay("--study unseen --sensors 64");
    EXPECT_EQ(sensor.exitCode, 1);
    expectHas(sensor.err, "--sensors: 64 is none of 2d");
    EXPECT_EQ(replay("--study dynamics --seeds 0").exitCode, 2);
    EXPECT_EQ(replay("--study dynamics x.rawlog").exitCode, 2);
}
