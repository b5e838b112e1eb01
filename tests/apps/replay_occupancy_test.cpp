#include "replay_map_fixture.h"

using ReplayOccupancy = ReplayFolder;

TEST_F(ReplayOccupancy, BaselinesAreEvaluatedBesideTheMap) {
    const Outcome outcome =
        replay(recordRoom() + " --split 4 --baselines octomap:0.1,octomap:0.4" +
               " --report " + path("report"));
    ASSERT_EQ(outcome.exitCode, 0) << outcome.err;
    const auto json = metrics("report");
    ASSERT_EQ(json["maps"].size(), 3U);
    EXPECT_EQ(json["maps"][0]["name"], "hgmm");
    EXPECT_EQ(json["maps"][1]["name"], "octomap:0.1");
    EXPECT_EQ(json["maps"][2]["name"], "octomap:0.4");
    for (const auto& map : json["maps"]) {
        expectHas(outcome.out, map["name"]);
        EXPECT_EQ(map["hits"], 3 * 2000);
        EXPECT_EQ(map["near_free_points"], 3 * 2000) << "no wall is nearer than 0.6 m";
        EXPECT_GT(map["scan_ms_median"], 0.0);
        EXPECT_GT(map["bytes_live"], 0);
        EXPECT_GE(map["roc"].size(), 2U);
        EXPECT_EQ(map["reliability"].size(), 15U);
    }
    const auto& fine = json["maps"][1];
    const auto& coarse = json["maps"][2];
    EXPECT_EQ(fine["class"], "mrpt::maps::COctoMap");
    EXPECT_EQ(fine["options"]["resolution"], 0.1);
    EXPECT_GT(fine["auc_uniform"], 0.95) << "an empty room is easy";
    EXPECT_GT(fine["auc_near"], double(coarse["auc_near"]) + 0.05)
        << "voxels of 0.4 m hold walls and what is before them";
    EXPECT_GT(fine["bytes_live"], coarse["bytes_live"]);
    expectHas(outcome.out, "unseen: ");
    EXPECT_GT(fine["unseen_points_behind_hits"], 1000);
    // Unseen points are 10 cm and more from all rays: not in a voxel of theirs.
    EXPECT_EQ(fine["unseen_called_free_behind_hits"], 0.0);
    EXPECT_EQ(fine["unseen_called_free_in_box"], 0.0);
    EXPECT_EQ(fine["unseen_called_occupied"], 0.0);
    EXPECT_EQ(fine["unseen_mean_p_unknown"], 1.0);
    EXPECT_GT(coarse["unseen_called_occupied"], 0.02) << "behind walls, in their voxels";
}

TEST_F(ReplayOccupancy, BaselinesDoNotChangeTheMap) {
    const std::string command = recordRoom() + " --split 4 --save-map ";
    ASSERT_EQ(replay(command + path("alone.hgmm")).exitCode, 0);
    ASSERT_EQ(replay(command + path("beside.hgmm") + " --baselines octomap:0.2").exitCode,
              0);
    ASSERT_FALSE(content("alone.hgmm").empty());
    EXPECT_TRUE(content("alone.hgmm") == content("beside.hgmm"));
}

TEST_F(ReplayOccupancy, LevelsHaveFiguresOfTheirOwn) {
    ASSERT_EQ(replay(recordRoom() + " --split 4 --report " + path("report")).exitCode, 0);
    const auto map = metrics("report")["maps"][0];
    ASSERT_GT(map["levels"].size(), 1U);
    EXPECT_EQ(map["levels"][0]["auc_near"], map["auc_near"]);
    EXPECT_EQ(map["levels"][0]["components_free"], map["components_free"]);
    for (const auto& level : map["levels"]) {
        EXPECT_GT(level["auc_uniform"], 0.5);
        EXPECT_LE(level["auc_uniform"], 1.0);
    }
    EXPECT_LT(map["levels"].back()["bytes"], map["levels"][0]["bytes"]);
}

TEST_F(ReplayOccupancy, TheRoomIsOccupiedAtItsWallsAndFreeBetween) {
    ASSERT_EQ(replay(recordRoom() + " --split 4 --report " + path("report")).exitCode, 0);
    const auto map = metrics("report")["maps"][0];
    EXPECT_GT(map["auc_uniform"], 0.99);
    EXPECT_GT(map["auc_near"], 0.95);
    EXPECT_GT(map["balanced_accuracy_near"], 0.9);
    EXPECT_GT(map["components_free"], 0);
    EXPECT_LT(map["unknown_share_hit"], 0.05);
    EXPECT_LT(map["unknown_share_free"], 0.05);
}

TEST_F(ReplayOccupancy, BandsOfFreePointsFollowSensorAndOptions) {
    const std::string room = recordRoom();
    ASSERT_EQ(replay(room + " --split 4 --report " + path("a")).exitCode, 0);
    EXPECT_EQ(metrics("a")["protocol"]["near_m"], nlohmann::json({0.1, 0.6}));
    EXPECT_EQ(metrics("a")["protocol"]["free_band_m"], nlohmann::json({0.1, 0.15}));
    const Outcome outcome =
        replay(room + " --holdout-points 0.2 --near 0.5,2.5 --free-band 0,0.2 --report " +
               path("b"));
    ASSERT_EQ(outcome.exitCode, 0) << outcome.err;
    const auto json = metrics("b");
    EXPECT_EQ(json["protocol"]["near_m"], nlohmann::json({0.5, 2.5}));
    EXPECT_EQ(json["protocol"]["free_band_m"], nlohmann::json({0.0, 0.2}));
    EXPECT_EQ(json["maps"][0]["uniform_free_points"], json["maps"][0]["hits"]);
    EXPECT_LT(json["maps"][0]["near_free_points"], json["maps"][0]["hits"])
        << "floor and ceiling are nearer than 2.5 m";
    expectHas(outcome.out, "left out: 0 rays too short for a uniform point");
}

TEST_F(ReplayOccupancy, RaysTooShortForAnyFreePointLeaveOccupancyOut) {
    const Outcome outcome =
        replay(recordRoom() + " --split 4 --near 50,60 --report " + path("report"));
    ASSERT_EQ(outcome.exitCode, 0) << outcome.err;
    EXPECT_FALSE(metrics("report")["maps"][0].contains("auc_near"));
    EXPECT_TRUE(metrics("report")["maps"][0].contains("f1_5cm"));
}

TEST_F(ReplayOccupancy, WrongUsageIsTwo) {
    const std::string room = recordRoom(2, 100);
    EXPECT_EQ(replay(room + " --near 0.3").exitCode, 2);
    EXPECT_EQ(replay(room + " --near 0.3,0.1").exitCode, 2);
    EXPECT_EQ(replay(room + " --near=-0.1,0.1").exitCode, 2);
    EXPECT_EQ(replay(room + " --free-band 0.1").exitCode, 2);
    EXPECT_EQ(replay(room + " --free-band=0.1,-1").exitCode, 2);
    EXPECT_EQ(replay(room + " --free-band 0.1,x").exitCode, 2);
    const Outcome unknown = replay(room + " --baselines voxels:0.1");
    EXPECT_EQ(unknown.exitCode, 1);
    expectHas(unknown.err, "voxels:0.1");
    expectHas(unknown.err, "octomap");
    EXPECT_EQ(replay(room + " --baselines octomap:-1").exitCode, 1);
}
