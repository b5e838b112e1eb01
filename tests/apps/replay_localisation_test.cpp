#include <regex>

#include "replay_map_fixture.h"

/// Studies of likelihood and registration, in a room whose poses are exact.
class ReplayLocalisation : public ReplayFolder {
 protected:
    /// The numbers of a row: count, share, metres, degrees.
    static std::vector<double> row(const std::string& text, const std::string& label) {
        const auto at = text.find(label);
        if (at == std::string::npos) {
            ADD_FAILURE() << label << " is not in " << text;
            return {0, 0, 0, 0};
        }
        std::istringstream fields(text.substr(at + label.size()));
        std::string m;
        std::vector<double> v(4);
        fields >> v[0] >> v[1] >> v[2] >> m >> v[3];
        return v;
    }
};

TEST_F(ReplayLocalisation, LandscapeHasItsMaximumAtTheTruth) {
    const Outcome outcome =
        replay(recordRoom(12, 800) + " --study landscape --split 6 --report '" +
               path("report") + "'");
    ASSERT_EQ(outcome.exitCode, 0) << outcome.err;
    const auto highest = row(outcome.out, "maximum, from the recording's pose");
    EXPECT_EQ(highest[0], 2);
    EXPECT_EQ(highest[1], 1) << outcome.out;
    EXPECT_LT(highest[2], 0.02);
    EXPECT_LT(highest[3], 0.5);
    const auto climbs = row(outcome.out, "climbs, from the recording's pose");
    EXPECT_EQ(climbs[0], 40);
    EXPECT_GE(climbs[1], 0.8) << outcome.out;
    EXPECT_LT(row(outcome.out, "registration, from the recording's pose")[2], 0.01);
    const std::string csv = content("report/landscape.csv");
    EXPECT_EQ(std::count(csv.begin(), csv.end(), '\n'), 3) << csv;
}

// Planar lasers are searched in x, y and yaw.
TEST_F(ReplayLocalisation, LandscapeOfALaserHasItsMaximumAtTheTruth) {
    box_room::Entries lasers;
    for (std::size_t i = 0; i < 24; ++i)
        lasers.push_back(
            box_room::laser(box_room::robotPose(i), box_room::timeOfScan(i), 361));
    box_room::writeRawlog(path("laser.rawlog"), lasers);
    box_room::writePoses(path("laser.tum"), 24);
    const Outcome outcome = replay("'" + path("laser.rawlog") + "' --poses '" +
                                   path("laser.tum") + "' --study landscape --split 6");
    ASSERT_EQ(outcome.exitCode, 0) << outcome.err;
    const auto highest = row(outcome.out, "maximum, from the recording's pose");
    EXPECT_EQ(highest[0], 4);
    EXPECT_EQ(highest[1], 1) << outcome.out;
    EXPECT_GE(row(outcome.out, "climbs, from the recording's pose")[1], 0.95)
        << outcome.out;
}

// A drift that grows along the recording moves the maximum in a map of all scans, not in
// one of neighbours.
TEST_F(ReplayLocalisation, LocalLandscapeBearsDrift) {
    const std::string log = recordRoom(24, 400, 0.015);
    const std::string label = "maximum, from the recording's pose";
    const Outcome local = replay(log + " --study landscape-local --split 12");
    ASSERT_EQ(local.exitCode, 0) << local.err;
    EXPECT_EQ(row(local.out, label)[0], 2);
    EXPECT_EQ(row(local.out, label)[1], 1) << local.out;
    const Outcome global = replay(log + " --study landscape --split 12");
    EXPECT_GT(row(global.out, label)[2], 2 * row(local.out, label)[2]) << global.out;
}

TEST_F(ReplayLocalisation, LandscapeDoesNotDependOnThreads) {
    const std::string study =
        recordRoom(8, 400) + " --study landscape --split 8 --threads ";
    const Outcome one = replay(study + "1");
    ASSERT_EQ(one.exitCode, 0) << one.err;
    EXPECT_EQ(replay(study + "3").out, one.out);
}

TEST_F(ReplayLocalisation, LandscapeNeedsTestScans) {
    EXPECT_EQ(replay(recordRoom(2, 200) + " --study landscape").exitCode, 2);
    const Outcome none = replay(recordRoom(2, 200) + " --study landscape --split 9");
    EXPECT_EQ(none.exitCode, 1);
    expectHas(none.err, "no scan was left to test");
    EXPECT_EQ(replay(recordRoom(2, 200) + " --study landscape-local").exitCode, 2);
    EXPECT_EQ(replay(recordRoom(1, 200) + " --study landscape-local --split 2").exitCode,
              1);
}

TEST_F(ReplayLocalisation, RegistrationFindsPairs) {
    const Outcome outcome = replay(recordRoom(8, 2000) + " --study registration");
    ASSERT_EQ(outcome.exitCode, 0) << outcome.err;
    std::smatch row;
    ASSERT_TRUE(std::regex_search(outcome.out, row,
                                  std::regex("hgmm +9 +([0-9.]+) +([0-9.]+) +([0-9.]+)")))
        << outcome.out;
    EXPECT_GE(std::stod(row[1]), 0.85);
    EXPECT_LT(std::stod(row[2]), 0.02);
    EXPECT_LT(std::stod(row[3]), 0.3);
    expectHas(outcome.out, "bench-registration");
}

TEST_F(ReplayLocalisation, RegistrationNeedsPairs) {
    const Outcome outcome = replay(recordRoom(4, 500) + " --study registration");
    EXPECT_EQ(outcome.exitCode, 1);
    expectHas(outcome.err, "no two scans are 5 apart");
}
