// hgmm-localise, in a map of the room that its log was recorded in.
#include <algorithm>
#include <cstdio>

#include "replay_map_fixture.h"

/// A saved map of the box room, and a log with a pose file.
class Localise : public ReplayFolder {
 protected:
    void SetUp() override {
        ReplayFolder::SetUp();
        ASSERT_EQ(replay(recordRoom(6, 1500) + " --save-map " + path("room.hgmm")).exitCode,
                  0);
    }
    Outcome localise(const std::string& arguments) const {
        return run("hgmm-localise", "'" + path("room.hgmm") + "' " + arguments);
    }
    std::string start() const {
        const auto pose = box_room::robotPose(0);
        char text[200];
        std::snprintf(text, sizeof text, " --start=%.3f,%.3f,%.3f,%.2f,%.2f,%.2f",
                      pose.x() + 0.1, pose.y() - 0.1, pose.z(), pose.yaw() * 57.29578 + 3.0,
                      pose.pitch() * 57.29578, pose.roll() * 57.29578);
        return text;
    }
};

TEST_F(Localise, FollowsTheRobotOfALog) {
    const Outcome outcome =
        localise("'" + path("room.rawlog") + "'" + start() + " -o '" + path("found.tum") +
                 "' --covariances '" + path("found.csv") + "' --print");
    ASSERT_EQ(outcome.exitCode, 0) << outcome.err;
    expectHas(outcome.err, "scans  6, 0 lost");
    const auto found = hgmm::evaluation::readTrajectory(path("found.tum"));
    ASSERT_EQ(found.size(), 6U);
    for (std::size_t i = 0; i < found.size(); ++i) {
        const auto truth = hgmm::mrpt_bridge::toPose(box_room::robotPose(i));
        EXPECT_NEAR(found[i].stamp, box_room::timeOfScan(i), 1e-5);
        EXPECT_LT((found[i].T_world_frame.t - truth.t).norm(), 0.05) << i;
        EXPECT_TRUE(found[i].T_world_frame.R.isApprox(truth.R, 0.02)) << i;
    }
    const std::string rows = content("found.csv");
    EXPECT_EQ(std::count(rows.begin(), rows.end(), '\n'), 7);
    EXPECT_EQ(std::count(outcome.out.begin(), outcome.out.end(), '\n'), 6);
}

TEST_F(Localise, BadInputIsSaid) {
    const std::string log = "'" + path("room.rawlog") + "'";
    EXPECT_EQ(localise("").exitCode, 2);
    EXPECT_EQ(localise(log + " --start 1,2,3").exitCode, 2);
    Outcome outcome = localise(log + " --start nan,0,0,0,0,0");
    EXPECT_EQ(outcome.exitCode, 1);
    expectHas(outcome.err, "--start");
    outcome = localise(log + start() + " --sensor nobody");
    EXPECT_EQ(outcome.exitCode, 1);
    expectHas(outcome.err, "nobody");
    outcome = localise("'" + path("none.rawlog") + "'");
    EXPECT_EQ(outcome.exitCode, 1);
    expectHas(outcome.err, "none.rawlog");
    outcome = localise(log + start() + " -o '" + path("room.hgmm") + "'");
    EXPECT_EQ(outcome.exitCode, 1);
    expectHas(outcome.err, "room.hgmm");
}

TEST_F(Localise, ReadsScansFromStandardInput) {
    const auto send = [&](const std::string& bytes) {
        {
            std::ofstream out(path("scans.bin"), std::ios::binary);
            out << bytes;
        }
        const std::string command = std::string(HGMM_BIN_DIR) + "/hgmm-localise '" +
                                    path("room.hgmm") + "' -" + start() + " --print <'" +
                                    path("scans.bin") + "' >'" + path("stdout") + "' 2>'" +
                                    path("stderr") + "'";
        const int status = std::system(command.c_str());
        return Outcome{WIFEXITED(status) ? WEXITSTATUS(status) : -1, content("stdout"),
                       content("stderr")};
    };
    const float point[3] = {1.F, 0.F, 0.F};
    std::string bytes = "scan 1.5 1\n";
    bytes.append(reinterpret_cast<const char*>(point), sizeof point);
    Outcome outcome = send(bytes);
    EXPECT_EQ(outcome.exitCode, 0) << outcome.err;
    expectHas(outcome.out, "1.500000 lost");
    outcome = send(bytes.substr(0, bytes.size() - 1));
    EXPECT_EQ(outcome.exitCode, 1);
    expectHas(outcome.err, "ends after 0 of 1");
    outcome = send("ply\n");
    EXPECT_EQ(outcome.exitCode, 1);
    expectHas(outcome.err, "scan TIME POINTS");
}
