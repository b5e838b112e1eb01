#include <signal.h>
#include <unistd.h>

#include <chrono>
#include <thread>

#include "replay_map_fixture.h"

using ReplayBadInput = ReplayFolder;

TEST_F(ReplayBadInput, WrongUsageIsTwo) {
    const std::string room = recordRoom(2, 100);
    EXPECT_EQ(replay("").exitCode, 2);
    EXPECT_EQ(replay(room + " --no-such-option").exitCode, 2);
    EXPECT_EQ(replay(room + " --split 1").exitCode, 2);
    EXPECT_EQ(replay(room + " --split x").exitCode, 2);
    EXPECT_EQ(replay(room + " --subsample 0").exitCode, 2);
    EXPECT_EQ(replay(room + " --holdout-points 1").exitCode, 2);
    EXPECT_EQ(replay(room + " --from 3 --to 2").exitCode, 2);
    EXPECT_EQ(replay(room + " --from -1").exitCode, 2);
    EXPECT_EQ(replay(room + " --threads -2").exitCode, 2);
    EXPECT_EQ(replay(room + " --study nonsense").exitCode, 2);
    EXPECT_EQ(replay("--help").exitCode, 0);
}

TEST_F(ReplayBadInput, UnusableRecordingsAreOneAndNamed) {
    const Outcome missing = replay(path("missing.rawlog"));
    EXPECT_EQ(missing.exitCode, 1);
    expectHas(missing.err, "missing.rawlog");
    std::ofstream(path("empty.rawlog")).close();
    const Outcome empty = replay(path("empty.rawlog"));
    EXPECT_EQ(empty.exitCode, 1);
    expectHas(empty.err, "is empty");
    std::ofstream(path("text.rawlog")) << "these are words, and no recording\n";
    EXPECT_EQ(replay(path("text.rawlog")).exitCode, 1);
}

TEST_F(ReplayBadInput, PosesAreNeededAndMustCover) {
    recordRoom(8, 200);
    const Outcome without = replay(path("room.rawlog"));
    EXPECT_EQ(without.exitCode, 1);
    expectHas(without.err, "--poses");
    box_room::writePoses(path("short.tum"), 3);
    const Outcome tooShort = replay(path("room.rawlog") + " --poses " + path("short.tum"));
    EXPECT_EQ(tooShort.exitCode, 1);
    expectHas(tooShort.err, "of 8 scans have no pose");
    EXPECT_EQ(replay(path("room.rawlog") + " --poses " + path("none.tum")).exitCode, 1);
}

TEST_F(ReplayBadInput, ATruncatedRecordingIsUsedUpToTheDamage) {
    const std::string room = recordRoom(12, 1000);
    box_room::truncateFile(path("room.rawlog"), 0.5);
    const Outcome outcome = replay(room + " --split 4 --report " + path("report"));
    ASSERT_EQ(outcome.exitCode, 0) << outcome.err;
    expectHas(outcome.err, "warning");
    expectHas(outcome.err, "bytes are lost");
    const auto json = metrics("report");
    const int scans =
        int(json["dataset"]["scans_mapped"]) + int(json["dataset"]["scans_tested"]);
    EXPECT_GE(scans, 5);
    EXPECT_LE(scans, 7);
    expectHas(outcome.err, std::to_string(scans) + " scans can be used");
}

TEST_F(ReplayBadInput, OutputsThatCannotBeWrittenAreOne) {
    const std::string room = recordRoom(2, 100);
    const Outcome map = replay(room + " --save-map " + path("no/such/folder/m.hgmm"));
    EXPECT_EQ(map.exitCode, 1);
    expectHas(map.err, "m.hgmm");
    std::ofstream(path("file")) << "in the way";
    EXPECT_EQ(replay(room + " --report " + path("file/report")).exitCode, 1);
}

TEST_F(ReplayBadInput, InterruptedRunsReportWhatIsFinished) {
    // Far more scans than are done when the signal comes.
    const std::string room = recordRoom(600, 3000);
    const std::string program = std::string(HGMM_BIN_DIR) + "/hgmm-replay";
    const std::string log = path("room.rawlog"), poses = path("room.tum");
    const std::string report = path("report"), err = path("stderr");
    const pid_t child = fork();
    ASSERT_GE(child, 0);
    if (child == 0) {
        if (!freopen(err.c_str(), "w", stderr) || !freopen("/dev/null", "w", stdout))
            _exit(99);
        execl(program.c_str(), program.c_str(), log.c_str(), "--poses", poses.c_str(),
              "--report", report.c_str(), static_cast<char*>(nullptr));
        _exit(98);
    }
    // The first line of progress says that replaying has begun.
    for (int i = 0; i < 6000 && content("stderr").find("scans/s") == std::string::npos; ++i)
        std::this_thread::sleep_for(std::chrono::milliseconds(10));
    kill(child, SIGINT);
    int status = 0;
    ASSERT_EQ(waitpid(child, &status, 0), child);
    ASSERT_TRUE(WIFEXITED(status));
    EXPECT_EQ(WEXITSTATUS(status), 130);
    expectHas(content("stderr"), "interrupted");
    const auto json = metrics("report");
    EXPECT_EQ(json["dataset"]["interrupted"], true);
    EXPECT_GE(int(json["dataset"]["scans_mapped"]), 60);
    EXPECT_LT(int(json["dataset"]["scans_mapped"]), 600);
}
