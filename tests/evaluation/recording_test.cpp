#include "hgmm/evaluation/recording.h"

#include <gtest/gtest.h>
#include <mrpt/obs/CObservationComment.h>

#include <functional>

#include "box_room.h"
#include "scratch_folder.h"

using namespace hgmm::evaluation;
using box_room::Entries;
using mrpt::poses::CPose3D;

namespace {

class RecordingOf : public ScratchFolder {
 protected:
    /// Runs something that must throw, and returns the message.
    static std::string messageOf(const std::function<void()>& action) {
        try {
            action();
        } catch (const std::exception& e) {
            return e.what();
        }
        ADD_FAILURE() << "nothing was thrown";
        return "";
    }
    static void expectHas(const std::string& text, const std::string& part) {
        EXPECT_NE(text.find(part), std::string::npos) << "\"" << part << "\" in: " << text;
    }
    static void expectNear(const CPose3D& a, const CPose3D& b, double tolerance) {
        EXPECT_LT((a - b).norm(), tolerance) << a << " against " << b;
        EXPECT_LT(
            (a.getRotationMatrix().asEigen() - b.getRotationMatrix().asEigen()).norm(),
            tolerance);
    }
};

std::vector<RecordedScan> readAll(Recording& recording) {
    std::vector<RecordedScan> scans;
    while (auto scan = recording.next()) scans.push_back(*scan);
    return scans;
}

/// Pairs of actions and frames whose motions lead along box_room::robotPose.
Entries actionPairs(std::size_t scans, bool in3d) {
    Entries entries;
    for (std::size_t i = 0; i < scans; ++i) {
        const CPose3D before = i == 0 ? CPose3D() : box_room::robotPose(i - 1);
        const CPose3D increment = box_room::robotPose(i) - before;
        auto actions = mrpt::obs::CActionCollection::Create();
        if (in3d) {
            mrpt::obs::CActionRobotMovement3D motion;
            motion.poseChange.mean = increment;
            motion.rawOdometryIncrementReading = increment;
            actions->insert(motion);
        } else {
            mrpt::obs::CActionRobotMovement2D motion;
            motion.computeFromOdometry(mrpt::poses::CPose2D(increment), {});
            actions->insert(motion);
        }
        auto frame = mrpt::obs::CSensoryFrame::Create();
        frame->insert(box_room::laser(box_room::robotPose(i), box_room::timeOfScan(i), 91));
        entries.push_back(actions);
        entries.push_back(frame);
    }
    return entries;
}

}  // namespace

TEST_F(RecordingOf, ObservationsGetTheirPosesFromAFileByTime) {
    box_room::writeRawlog(path("a.rawlog"), box_room::observations(8, 50));
    box_room::writePoses(path("a.tum"), 8);
    Recording recording(path("a.rawlog"), {path("a.tum")});
    EXPECT_EQ(recording.size(), 8U);
    EXPECT_EQ(recording.poseSource(), PoseSource::file);
    EXPECT_EQ(recording.sensor(), "mrpt::obs::CObservationPointCloud");
    EXPECT_EQ(recording.damage(), "");
    const auto scans = readAll(recording);
    ASSERT_EQ(scans.size(), 8U);
    for (std::size_t i = 0; i < 8; ++i) {
        EXPECT_EQ(scans[i].index, i);
        EXPECT_NEAR(scans[i].time_s, box_room::timeOfScan(i), 1e-5);
        expectNear(scans[i].T_map_robot, box_room::robotPose(i), 1e-5);
    }
}

TEST_F(RecordingOf, PosesBetweenStampsAreInterpolated) {
    Entries entries{box_room::pointCloud({}, box_room::kStart_s + 0.025, 10)};
    box_room::writeRawlog(path("a.rawlog"), entries);
    writeTumTrajectory(
        path("a.tum"),
        {{box_room::kStart_s, hgmm::mrpt_bridge::toPose(CPose3D(1, 0, 0, 0, 0, 0))},
         {box_room::kStart_s + 0.1,
          hgmm::mrpt_bridge::toPose(CPose3D(2, 4, 0, 0.4, 0, 0))}});
    Recording recording(path("a.rawlog"), {path("a.tum")});
    expectNear(recording.next()->T_map_robot, CPose3D(1.25, 1, 0, 0.1, 0, 0), 1e-4);
}

TEST_F(RecordingOf, PosesThatDoNotCoverTheScansAreCounted) {
    box_room::writeRawlog(path("a.rawlog"), box_room::observations(10, 20));
    box_room::writePoses(path("a.tum"), 6);
    // The last pose is 0.1 s before scan 6, so that scan is still within reach of it.
    const std::string message =
        messageOf([&] { Recording(path("a.rawlog"), {path("a.tum")}); });
    EXPECT_TRUE(message.find("3 of 10 scans") != std::string::npos ||
                message.find("4 of 10 scans") != std::string::npos)
        << message;
    expectHas(message, "a.tum");
    RecordingOptions covered{path("a.tum")};
    covered.to = 5;
    EXPECT_EQ(Recording(path("a.rawlog"), covered).size(), 6U);
}

TEST_F(RecordingOf, MotionsOfActionsAreComposedIn2dAnd3d) {
    for (const bool in3d : {false, true}) {
        box_room::writeRawlog(path("a.rawlog"), actionPairs(6, in3d));
        Recording recording(path("a.rawlog"));
        EXPECT_EQ(recording.poseSource(), PoseSource::odometry);
        const auto scans = readAll(recording);
        ASSERT_EQ(scans.size(), 6U);
        for (std::size_t i = 0; i < 6; ++i)
            expectNear(scans[i].T_map_robot, box_room::robotPose(i), 1e-6);
    }
}

TEST_F(RecordingOf, AllScansOfAFrameShareItsPose) {
    Entries entries = actionPairs(2, false);
    auto& frame = dynamic_cast<mrpt::obs::CSensoryFrame&>(*entries[1]);
    frame.insert(box_room::pointCloud(box_room::robotPose(0), box_room::timeOfScan(0), 30));
    box_room::writeRawlog(path("a.rawlog"), entries);
    Recording recording(path("a.rawlog"));
    const auto scans = readAll(recording);
    ASSERT_EQ(scans.size(), 3U);
    expectNear(scans[1].T_map_robot, scans[0].T_map_robot, 1e-12);
    EXPECT_EQ(scans[2].index, 2U);
    expectNear(scans[2].T_map_robot, box_room::robotPose(1), 1e-6);
}

TEST_F(RecordingOf, OdometryReadingsAreInterpolatedByTime) {
    Entries entries;
    for (int i = 0; i < 2; ++i) {
        auto reading = mrpt::obs::CObservationOdometry::Create();
        reading->timestamp = mrpt::Clock::fromDouble(box_room::kStart_s + i);
        reading->odometry = mrpt::poses::CPose2D(2.0 * i, 0, 0.5 * i);
        entries.push_back(reading);
    }
    for (const double dt : {0.5, 3.0})
        entries.push_back(box_room::laser({}, box_room::kStart_s + dt, 31));
    box_room::writeRawlog(path("a.rawlog"), entries);
    Recording recording(path("a.rawlog"));
    EXPECT_EQ(recording.poseSource(), PoseSource::odometry);
    expectNear(recording.next()->T_map_robot, CPose3D(1, 0, 0, 0.25, 0, 0), 1e-6);
    expectNear(recording.next()->T_map_robot, CPose3D(2, 0, 0, 0.5, 0, 0), 1e-6);
}

TEST_F(RecordingOf, OneScanNeedsNoPoseButSeveralDo) {
    box_room::writeRawlog(path("one.rawlog"), box_room::observations(1, 20));
    Recording one(path("one.rawlog"));
    EXPECT_EQ(one.poseSource(), PoseSource::identity);
    expectNear(one.next()->T_map_robot, CPose3D(), 1e-12);
    EXPECT_FALSE(one.next());

    box_room::writeRawlog(path("two.rawlog"), box_room::observations(2, 20));
    const std::string message = messageOf([&] { Recording(path("two.rawlog")); });
    expectHas(message, "two.rawlog");
    expectHas(message, "2 scans");
    expectHas(message, "--poses");
    RecordingOptions withoutPoses;
    withoutPoses.posesRequired = false;
    EXPECT_EQ(Recording(path("two.rawlog"), withoutPoses).size(), 2U);
}

TEST_F(RecordingOf, ARangeOfScansKeepsItsIndicesAndPoses) {
    box_room::writeRawlog(path("a.rawlog"), actionPairs(10, false));
    RecordingOptions options;
    options.from = 3;
    options.to = 5;
    Recording recording(path("a.rawlog"), options);
    EXPECT_EQ(recording.size(), 3U);
    const auto scans = readAll(recording);
    ASSERT_EQ(scans.size(), 3U);
    EXPECT_EQ(scans.front().index, 3U);
    EXPECT_EQ(scans.back().index, 5U);
    expectNear(scans.front().T_map_robot, box_room::robotPose(3), 1e-6);
    options.from = 10;
    options.to = 20;
    expectHas(messageOf([&] { Recording(path("a.rawlog"), options); }), "10 scans");
}

TEST_F(RecordingOf, WhatComesBeforeTheDamageIsUsed) {
    const Entries entries = box_room::observations(10, 400);
    box_room::writePoses(path("a.tum"), 10);
    for (const bool compressed : {true, false}) {
        const std::string file = path(compressed ? "gz.rawlog" : "plain.rawlog");
        compressed ? box_room::writeRawlog(file, entries)
                   : box_room::writeUncompressedRawlog(file, entries);
        box_room::truncateFile(file, 0.55);
        Recording recording(file, {path("a.tum")});
        EXPECT_GE(recording.size(), 4U);
        EXPECT_LE(recording.size(), 6U);
        EXPECT_EQ(readAll(recording).size(), recording.size());
        expectHas(recording.damage(), file);
        expectHas(recording.damage(), std::to_string(recording.size()) + " scans");
        expectHas(recording.damage(), "bytes are lost");
    }
}

TEST_F(RecordingOf, AFileCutBetweenEntriesButNotItsCompressionIsDamagedToo) {
    box_room::writeRawlog(path("a.rawlog"), box_room::observations(3, 100));
    // The checksum at the end alone is missing.
    std::filesystem::resize_file(path("a.rawlog"),
                                 std::filesystem::file_size(path("a.rawlog")) - 4);
    box_room::writePoses(path("a.tum"), 3);
    Recording recording(path("a.rawlog"), {path("a.tum")});
    EXPECT_EQ(recording.size(), 3U);
    EXPECT_NE(recording.damage(), "");
}

TEST_F(RecordingOf, UnusableFilesAreNamed) {
    const std::string missing = path("missing.rawlog");
    expectHas(messageOf([&] { Recording{missing}; }), missing);
    std::ofstream(path("empty.rawlog")).close();
    expectHas(messageOf([&] { Recording(path("empty.rawlog")); }),
              "empty.rawlog: the file is empty");
    std::ofstream(path("text.rawlog")) << "this is no recording at all, but some words\n";
    expectHas(messageOf([&] { Recording(path("text.rawlog")); }), "text.rawlog");
    auto comment = mrpt::obs::CObservationComment::Create();
    box_room::writeRawlog(path("comment.rawlog"), {comment});
    expectHas(messageOf([&] { Recording(path("comment.rawlog")); }), "no range scans");
}

TEST_F(RecordingOf, TheTelecomLogEndsWhereItsOdometryDoes) {
    const std::string file =
        "/usr/share/mrpt/datasets/2006-01ENE-21-SENA_Telecom Faculty_one_loop_only.rawlog";
    if (!std::filesystem::exists(file))
        GTEST_SKIP() << "SKIPPED: mrpt-common is not installed";
    Recording recording(file);
    const auto scans = readAll(recording);
    ASSERT_EQ(scans.size(), 225U);
    const CPose3D& last = scans.back().T_map_robot;
    EXPECT_NEAR(last.x(), -4.80, 0.01);
    EXPECT_NEAR(last.y(), -21.16, 0.01);
    EXPECT_NEAR(mrpt::RAD2DEG(last.yaw()), -106.7, 0.1);
}
