#include "replay_map_fixture.h"

namespace {

/// Study room: exact geometry.
class ReplayRoom : public ReplayFolder {
 protected:
    /// "LOG --poses POSES" of a recording of the room without noise.
    std::string recordExactRoom(std::size_t scans) const {
        box_room::Entries entries;
        for (std::size_t i = 0; i < scans; ++i)
            entries.push_back(box_room::pointCloud(box_room::robotPose(i),
                                                   box_room::timeOfScan(i), 6000, 0.0));
        box_room::writeRawlog(path("exact.rawlog"), entries);
        box_room::writePoses(path("exact.tum"), scans);
        return "'" + path("exact.rawlog") + "' --poses '" + path("exact.tum") + "'";
    }
    nlohmann::json figures(const std::string& folder) const {
        return nlohmann::json::parse(content(folder + "/room.json"));
    }
};

}  // namespace

TEST_F(ReplayRoom, IsListed) {
    expectHas(replay("--list-studies").out, "room ");
}

TEST_F(ReplayRoom, FindsTheWallsAndAnswersRightAboutThem) {
    const Outcome outcome =
        replay(recordExactRoom(8) + " --split 4 --study room --range-noise 0.01 --report " +
               path("report"));
    ASSERT_EQ(outcome.exitCode, 0) << outcome.err;
    expectHas(outcome.out, "8.00 x 6.00 x 3.00 m");
    const auto f = figures("report");
    EXPECT_EQ(f["scans_mapped"], 6);
    EXPECT_EQ(f["wall_points"], 12000);
    EXPECT_EQ(f["range_noise_m"], 0.01);
    EXPECT_GT(f["wall_occupied"], 0.97);
    EXPECT_GT(f["free_not_occupied"], 0.995);
    EXPECT_LT(f["free_unknown"], 0.01);
    EXPECT_GT(f["hidden_unknown"], 0.97);
}

TEST_F(ReplayRoom, NoiseFollowsTheSeedAndIsForTheMapOnly) {
    const std::string command = recordExactRoom(4) + " --split 2 --save-map ";
    ASSERT_EQ(replay(command + path("none.hgmm")).exitCode, 0);
    const std::string noisy = " --range-noise 0.03 --report " + path("report");
    ASSERT_EQ(replay(command + path("a.hgmm") + noisy).exitCode, 0);
    ASSERT_EQ(replay(command + path("b.hgmm") + noisy).exitCode, 0);
    ASSERT_EQ(replay(command + path("c.hgmm") + noisy + " --seed 2").exitCode, 0);
    EXPECT_EQ(metrics("report")["protocol"]["range_noise_m"], 0.03);
    EXPECT_TRUE(content("a.hgmm") == content("b.hgmm"));
    EXPECT_FALSE(content("a.hgmm") == content("c.hgmm"));
    EXPECT_FALSE(content("a.hgmm") == content("none.hgmm"));
}

TEST_F(ReplayRoom, OtherRecordingsAndWrongUsageAreRefused) {
    const Outcome noisy = replay(recordRoom(4, 500) + " --split 2 --study room");
    EXPECT_EQ(noisy.exitCode, 1);
    expectHas(noisy.err, "room.rawlog: not a noiseless recording");
    const std::string room = recordExactRoom(3);
    EXPECT_EQ(replay(room + " --study room").exitCode, 2);
    EXPECT_EQ(replay(room + " --split 2 --range-noise -0.1").exitCode, 2);
    const Outcome untested = replay(room + " --split 100 --study room");
    EXPECT_EQ(untested.exitCode, 1);
    expectHas(untested.err, "no test scan");
}

// Issue 3, exact geometry.
TEST_F(ReplayRoom, Lidar16RoomIsOccupiedFreeAndUnknownWhereItShouldBe) {
    const char* data = std::getenv("HGMM_DATA_DIR");
    if (!data) GTEST_SKIP() << "SKIPPED: HGMM_DATA_DIR is not set";
    const std::string folder =
        std::filesystem::absolute(data).string() + "/lidar16_room_sim";
    const Outcome imported =
        run("hgmm-import", "pcd '" + folder + "' --poses '" + folder + "/poses_tum.txt' " +
                               "-o '" + path("room.rawlog") + "' --poses-out '" +
                               path("room.tum") + "'");
    ASSERT_EQ(imported.exitCode, 0) << imported.err;
    const Outcome outcome = replay(
        "'" + path("room.rawlog") + "' --poses '" + path("room.tum") +
        "' --split 4 --study room --range-noise 0.02 --report '" + path("report") + "'");
    ASSERT_EQ(outcome.exitCode, 0) << outcome.err;
    const auto f = figures("report");
    // Seeds 1 to 4 of the noise give .987 to .991.
    EXPECT_GE(f["wall_occupied"], 0.99) << outcome.out;
    EXPECT_GE(f["free_not_occupied"], 0.995) << outcome.out;
    EXPECT_LT(f["free_unknown"], 0.01) << outcome.out;
    EXPECT_GE(f["hidden_unknown"], 0.99) << outcome.out;
}
