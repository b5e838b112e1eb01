// hgmm-localise, in a map of the room that its log was recorded in.
#include <signal.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <filesystem>
#include <map>
#include <sstream>
#include <thread>
#include <vector>

#include "replay_map_fixture.h"

namespace {

using hgmm::Pose;

/// Rows of a CSV file with a header.
using Table = std::vector<std::map<std::string, double>>;

Table readTable(const std::string& text) {
    std::istringstream lines(text);
    std::string line, cell;
    std::vector<std::string> names;
    std::getline(lines, line);
    for (std::istringstream cells(line); std::getline(cells, cell, ',');)
        names.push_back(cell);
    Table table;
    while (std::getline(lines, line)) {
        table.emplace_back();
        std::size_t column = 0;
        for (std::istringstream cells(line); std::getline(cells, cell, ','); ++column)
            if (!cell.empty()) table.back()[names.at(column)] = std::stod(cell);
    }
    return table;
}

constexpr std::size_t kRoomScans = 6, kRoomPoints = 1500;

/// A saved map of the box room, and the log that it is made of.
class Localise : public ReplayFolder {
 protected:
    void SetUp() override {
        ReplayFolder::SetUp();
        const std::string room = recordRoom(kRoomScans, kRoomPoints);
        static const std::string map = [&] {
            replay(room + " --save-map '" + path("made.hgmm") + "'");
            return content("made.hgmm");
        }();
        ASSERT_FALSE(map.empty());
        std::ofstream(path("room.hgmm"), std::ios::binary) << map;
        std::filesystem::remove(path("stdout"));
    }

    Outcome localise(const std::string& arguments) const {
        return run("hgmm-localise", "'" + path("room.hgmm") + "' " + arguments);
    }
    std::string log() const { return "'" + path("room.rawlog") + "'"; }

    /// Near the truth; the same for a sensor that is so far above the robot.
    static std::string start(double above_m = 0.0) {
        const auto pose = box_room::robotPose(0);
        char text[200];
        std::snprintf(text, sizeof text, " --start=%.3f,%.3f,%.3f,%.2f,0,0", pose.x() + 0.1,
                      pose.y() - 0.1, pose.z() + above_m, pose.yaw() * 57.29578 + 3.0);
        return text;
    }

    static std::string streamed(double time_s, const hgmm::Scan& scan) {
        char header[100];
        std::snprintf(header, sizeof header, "scan %.6f %zu\n", time_s, scan.size());
        std::string bytes = header;
        for (std::size_t i = 0; i < scan.size(); ++i)
            for (const float value : {scan.x[i], scan.y[i], scan.z[i]})
                bytes.append(reinterpret_cast<const char*>(&value), sizeof value);
        return bytes;
    }
    /// The scans of the log.
    static std::string streamedRoom() {
        std::string bytes;
        for (std::size_t i = 0; i < kRoomScans; ++i)
            bytes += streamed(
                box_room::timeOfScan(i),
                *hgmm::mrpt_bridge::observationToScan(*box_room::pointCloud(
                    box_room::robotPose(i), box_room::timeOfScan(i), kRoomPoints)));
        return bytes;
    }

    Outcome send(const std::string& bytes, const std::string& arguments) const {
        std::ofstream(path("scans.bin"), std::ios::binary) << bytes;
        const std::string command = "cat '" + path("scans.bin") + "' | " + HGMM_BIN_DIR +
                                    "/hgmm-localise '" + path("room.hgmm") + "' - " +
                                    arguments + " >'" + path("stdout") + "' 2>'" +
                                    path("stderr") + "'";
        const int status = std::system(command.c_str());
        return {WIFEXITED(status) ? WEXITSTATUS(status) : -1, content("stdout"),
                content("stderr")};
    }
};

TEST_F(Localise, FollowsTheRobotOfALog) {
    const Outcome outcome = localise(log() + start() + " -o '" + path("found.tum") +
                                     "' --csv '" + path("found.csv") + "'");
    ASSERT_EQ(outcome.exitCode, 0) << outcome.err;
    expectHas(outcome.err, "6 scans, 0 lost");
    const auto found = hgmm::evaluation::readTrajectory(path("found.tum"));
    ASSERT_EQ(found.size(), kRoomScans);
    for (std::size_t i = 0; i < found.size(); ++i) {
        const Pose truth = hgmm::mrpt_bridge::toPose(box_room::robotPose(i));
        EXPECT_NEAR(found[i].stamp, box_room::timeOfScan(i), 1e-5);
        EXPECT_LT((found[i].T_world_frame.t - truth.t).norm(), 0.03) << i;
        EXPECT_TRUE(found[i].T_world_frame.R.isApprox(truth.R, 0.01)) << i;
    }
    EXPECT_EQ(content("found.csv"), outcome.out);
    const Table rows = readTable(outcome.out);
    ASSERT_EQ(rows.size(), kRoomScans);
    EXPECT_EQ(rows[3].at("lost"), 0.0);
    EXPECT_NEAR(rows[3].at("x"), found[3].T_world_frame.t.x(), 1e-6);
    EXPECT_EQ(localise(log() + start() + " --quiet").out, "");
}

TEST_F(Localise, StandardInputGivesTheSensorsPoses) {
    const Outcome ofRobot = localise(log() + start()),
                  ofSensor = send(streamedRoom(), start(0.2));
    ASSERT_EQ(ofSensor.exitCode, 0) << ofSensor.err;
    const Table robot = readTable(ofRobot.out), sensor = readTable(ofSensor.out);
    ASSERT_EQ(sensor.size(), kRoomScans);
    ASSERT_EQ(robot.size(), kRoomScans);
    for (std::size_t i = 0; i < kRoomScans; ++i) {
        const auto &r = robot[i], &s = sensor[i];
        EXPECT_NEAR(r.at("z"), s.at("z") - 0.2, 1e-3);
        // The robot is arm_m along z from the sensor: x_robot = x + arm_m wy.
        const double arm_m = -0.2, wy_wy = s.at("wy_wy");
        EXPECT_NEAR(r.at("wy_wy"), wy_wy, 0.02 * wy_wy);
        const double x_x = s.at("x_x") + 2.0 * arm_m * s.at("wy_x") + arm_m * arm_m * wy_wy;
        EXPECT_NEAR(r.at("x_x"), x_x, 0.02 * x_x) << i;
    }
}

TEST_F(Localise, SaysWhereItIsLost) {
    // From a point, all walls of a hall four times as large are out of the room.
    hgmm::Scan hall = *hgmm::mrpt_bridge::observationToScan(*box_room::pointCloud(
        box_room::robotPose(0), box_room::timeOfScan(0), kRoomPoints));
    for (auto* values : {&hall.x, &hall.y, &hall.z})
        for (float& value : *values) value *= 4.0F;
    std::string elsewhere;
    for (int i = 1; i <= 3; ++i) elsewhere += streamed(box_room::timeOfScan(5) + i, hall);
    Outcome outcome =
        send(streamedRoom() + elsewhere, start(0.2) + " -o '" + path("found.tum") + "'");
    ASSERT_EQ(outcome.exitCode, 0) << outcome.err;
    const Table rows = readTable(outcome.out);
    ASSERT_EQ(rows.size(), kRoomScans + 3);
    for (std::size_t i = 0; i < rows.size(); ++i)
        EXPECT_EQ(rows[i].at("lost"), i < kRoomScans ? 0.0 : 1.0) << i;
    EXPECT_EQ(hgmm::evaluation::readTrajectory(path("found.tum")).size(), kRoomScans);

    // The room is the same after half a turn: a search does not choose.
    outcome = send(streamedRoom(), "");
    ASSERT_EQ(outcome.exitCode, 0) << outcome.err;
    for (const auto& row : readTable(outcome.out)) {
        EXPECT_EQ(row.at("lost"), 1.0);
        EXPECT_EQ(row.count("x"), 0U);
    }
}

TEST_F(Localise, BadInputIsSaid) {
    EXPECT_EQ(localise("").exitCode, 2);
    EXPECT_EQ(localise(log() + " --start 1,2,3").exitCode, 2);
    Outcome outcome = localise(log() + " --start nan,0,0,0,0,0");
    EXPECT_EQ(outcome.exitCode, 1);
    expectHas(outcome.err, "--start");
    outcome = localise(log() + start() + " --sensor nobody");
    EXPECT_EQ(outcome.exitCode, 1);
    expectHas(outcome.err, "nobody");
    outcome = localise("'" + path("none.rawlog") + "'");
    EXPECT_EQ(outcome.exitCode, 1);
    expectHas(outcome.err, "none.rawlog");
    const std::string map = content("room.hgmm");
    outcome = localise(log() + start() + " -o '" + path("room.hgmm") + "'");
    EXPECT_EQ(outcome.exitCode, 1);
    expectHas(outcome.err, "room.hgmm");
    EXPECT_EQ(content("room.hgmm"), map);
}

TEST_F(Localise, BadStreamsLoseNothingBeforeThem) {
    const std::string room = streamedRoom(), found = " -o '" + path("found.tum") + "'";
    Outcome outcome = send(room.substr(0, room.size() - 1), start(0.2) + found);
    EXPECT_EQ(outcome.exitCode, 1);
    expectHas(outcome.err, "stdin: scan 6 ends after 1499 of 1500 points");
    EXPECT_EQ(hgmm::evaluation::readTrajectory(path("found.tum")).size(), kRoomScans - 1);
    // Bad from the start: the file of before stays.
    for (const char* bytes : {"ply\n", "scan nan 1\n", "scan 1 -1\n"}) {
        outcome = send(bytes, start(0.2) + found);
        EXPECT_EQ(outcome.exitCode, 1) << bytes;
        expectHas(outcome.err, "scan TIME POINTS");
    }
    EXPECT_EQ(hgmm::evaluation::readTrajectory(path("found.tum")).size(), kRoomScans - 1);
    outcome = send("scan 2 0\nscan 1 0\n", start(0.2));
    EXPECT_EQ(outcome.exitCode, 1);
    expectHas(outcome.err, "scan 2 is earlier");
    EXPECT_EQ(readTable(outcome.out).size(), 1U);
}

TEST_F(Localise, RowsComeAtOnceAndCtrlCKeepsThem) {
    std::ofstream(path("scans.bin"), std::ios::binary) << streamedRoom();
    // The input stays open, so that only the signal ends the run.
    const std::string script = "exec 3<>'" + path("pipe") + "'; cat '" + path("scans.bin") +
                               "' >&3 & exec " + HGMM_BIN_DIR + "/hgmm-localise '" +
                               path("room.hgmm") + "' - " + start(0.2) + " -o '" +
                               path("found.tum") + "' <'" + path("pipe") + "' >'" +
                               path("stdout") + "' 2>'" + path("stderr") + "'";
    ASSERT_EQ(mkfifo(path("pipe").c_str(), 0600), 0);
    const pid_t child = fork();
    ASSERT_GE(child, 0);
    if (child == 0) {
        execl("/bin/bash", "bash", "-c", script.c_str(), static_cast<char*>(nullptr));
        _exit(98);
    }
    const auto rows = [&] {
        const std::string text = content("stdout");
        return std::count(text.begin(), text.end(), '\n');
    };
    for (int i = 0; i < 6000 && rows() < 1 + int(kRoomScans); ++i)
        std::this_thread::sleep_for(std::chrono::milliseconds(10));
    EXPECT_EQ(rows(), 1 + int(kRoomScans));
    EXPECT_FALSE(std::filesystem::exists(path("found.tum")));
    kill(child, SIGINT);
    int status = 0;
    ASSERT_EQ(waitpid(child, &status, 0), child);
    ASSERT_TRUE(WIFEXITED(status));
    EXPECT_EQ(WEXITSTATUS(status), 130);
    expectHas(content("stderr"), "interrupted after 6 scans");
    EXPECT_EQ(hgmm::evaluation::readTrajectory(path("found.tum")).size(), kRoomScans);
}

}  // namespace
