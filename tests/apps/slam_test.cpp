#include <hgmm/evaluation/planar_observation.h>
#include <hgmm/evaluation/trajectory.h>
#include <mrpt/maps/CHGMMOccupancyMap.h>
#include <mrpt/maps/CSimpleMap.h>
#include <mrpt/obs/CSensoryFrame.h>

#include <signal.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <sstream>
#include <thread>

#include "../slam/walk.h"
#include "replay_map_fixture.h"

namespace {

using namespace hgmm::slam::testing;
using hgmm::Pose;
using hgmm::evaluation::Trajectory;

/// Runs hgmm-slam on recordings of a laser in a corridor about a block.
class Slam : public ReplayFolder {
 protected:
    Outcome slam(const std::string& arguments) const { return run("hgmm-slam", arguments); }

    static mrpt::obs::CObservation::Ptr observationFrom(const Pose& truth, std::size_t i) {
        const Scene scene = ringCorridor();
        auto observation =
            mrpt::obs::CObservation2DRangeScan::Create(hgmm::evaluation::planarObservation(
                hgmm::evaluation::simulateReturns(scene, laser(), truth, {0.01, 0.0, 0.3},
                                                  3, i),
                laser(), 270.0, hgmm::evaluation::NoReturn::invalidZero));
        observation->timestamp = mrpt::Clock::fromDouble(1000.0 + 0.1 * double(i));
        observation->sensorLabel = i % 2 == 0 || !twoSensors ? "front" : "rear";
        return observation;
    }

    std::string recordWalk(const std::vector<Pose>& truth,
                           const std::string& out = "out") const {
        box_room::Entries observations;
        for (std::size_t i = 0; i < truth.size(); ++i)
            observations.push_back(observationFrom(truth[i], i));
        box_room::writeRawlog(path("walk.rawlog"), observations);
        return "'" + path("walk.rawlog") + "' -o '" + path(out) + "'";
    }

    std::string goingOnFrom(const std::string& name) const {
        return " --continue '" + path(name) + "'";
    }

    /// Ends a run with SIGKILL once it has saved a state.
    void killWhenSaved(const std::string& arguments, const std::string& state) const {
        const std::string command = "exec " HGMM_BIN_DIR "/hgmm-slam " + arguments +
                                    " --save-every 0 --quiet >/dev/null 2>&1";
        const pid_t child = fork();
        if (child == 0) {
            ::execl("/bin/sh", "sh", "-c", command.c_str(), nullptr);
            ::_exit(99);
        }
        int status = 0;
        while (!std::filesystem::exists(path(state)) &&
               ::waitpid(child, &status, WNOHANG) == 0)
            std::this_thread::sleep_for(std::chrono::milliseconds(1));
        ::kill(child, SIGKILL);
        ::waitpid(child, &status, 0);
        ASSERT_TRUE(std::filesystem::exists(path(state))) << "it was too fast";
    }

    inline static bool twoSensors = false;
};

TEST_F(Slam, WritesMapTrajectoryGraphAndKeyframes) {
    const std::vector<Pose> truth = walkAround(0.1, 0.12);
    const Outcome outcome = slam(recordWalk(truth));
    ASSERT_EQ(outcome.exitCode, 0) << outcome.err;
    expectHas(outcome.out, std::to_string(truth.size()) + " scans in ");

    const Trajectory trajectory =
        hgmm::evaluation::readTrajectory(path("out/trajectory.tum"));
    ASSERT_EQ(trajectory.size(), truth.size());
    for (std::size_t i = 0; i < truth.size(); ++i) {
        EXPECT_NEAR(trajectory[i].stamp, 1000.0 + 0.1 * double(i), 1e-4);
        EXPECT_LT(
            (trajectory[i].T_world_frame.t - (truth[0].inverse() * truth[i]).t).norm(), 0.1)
            << i;
    }

    mrpt::maps::CHGMMOccupancyMap map;
    map.loadFromFile(path("out/map.hgmm"));
    const auto at = [&](double x, double y) {
        const Eigen::Vector3d p =
            (truth[0].inverse() * Pose{Eigen::Matrix3d::Identity(), {x, y, 0}}).t;
        return map.model().occupancy(p);
    };
    EXPECT_GT(at(-4.0, -7.8).occupied, 0.5F);
    EXPECT_GT(at(-4.0, -6.0).free, 0.5F);

    mrpt::maps::CSimpleMap keyframes;
    ASSERT_TRUE(keyframes.loadFromFile(path("out/keyframes.simplemap")));
    ASSERT_GT(keyframes.size(), 2U);
    mrpt::poses::CPose3DPDF::ConstPtr pose;
    mrpt::obs::CSensoryFrame::ConstPtr frame;
    for (const auto& keyframe : keyframes) {
        pose = keyframe.pose;
        frame = keyframe.sf;
    }
    EXPECT_EQ(frame->size(), 1U);
    EXPECT_NEAR(pose->getMeanVal().x(), trajectory.back().T_world_frame.t.x(), 0.3);

    EXPECT_EQ(content("out/graph.g2o").rfind("VERTEX_SE3:QUAT 0 ", 0), 0U);
}

TEST_F(Slam, DrawsAReport) {
    const std::vector<Pose> truth = walkAround(0.1, 0.06);
    recordWalk(truth);
    std::filesystem::rename(path("walk.rawlog"), path("a<b & c.rawlog"));
    const Outcome outcome =
        slam("'" + path("a<b & c.rawlog") + "' -o '" + path("out") + "'");
    ASSERT_EQ(outcome.exitCode, 0) << outcome.err;
    const std::string svg = content("out/report.svg");
    EXPECT_EQ(svg.rfind("<svg ", 0), 0U);
    expectHas(svg, "a&lt;b &amp; c.rawlog");
    expectHas(svg, std::to_string(truth.size()) + " scans");
    expectHas(svg, " part</text>");

    // A point for each scan, as long as the way by the scale's bar.
    const std::size_t begin = svg.find("points=\"") + 8;
    std::istringstream points(svg.substr(begin, svg.find('"', begin) - begin));
    std::vector<Eigen::Vector2d> way;
    for (std::string point; points >> point;) {
        const std::size_t comma = point.find(',');
        way.emplace_back(std::stod(point), std::stod(point.substr(comma + 1)));
    }
    ASSERT_EQ(way.size(), truth.size());
    const std::size_t bar = svg.find("v8h") + 3;
    const std::size_t text = svg.find('>', svg.find("<text", bar)) + 1;
    const double metresPerPixel = std::stod(svg.substr(text)) / std::stod(svg.substr(bar));
    EXPECT_NEAR((way.back() - way.front()).norm() * metresPerPixel,
                (truth.back().t - truth.front().t).norm(), 0.1);
    // The robot drives along x, which points to the right.
    EXPECT_GT(way.back().x(), way.front().x());
}

TEST_F(Slam, OneLineAScanOfTheChosenSensor) {
    twoSensors = true;
    const std::string arguments = recordWalk(walkAround(0.1, 0.04));
    twoSensors = false;
    Outcome outcome = slam(arguments);
    ASSERT_EQ(outcome.exitCode, 0) << outcome.err;
    expectHas(outcome.err, "scans of 2 sensors; using those of front");
    EXPECT_EQ(hgmm::evaluation::readTrajectory(path("out/trajectory.tum")).size(), 10U);

    outcome = slam(arguments + " --sensor rear");
    ASSERT_EQ(outcome.exitCode, 0) << outcome.err;
    const Trajectory rear = hgmm::evaluation::readTrajectory(path("out/trajectory.tum"));
    ASSERT_EQ(rear.size(), 10U);
    EXPECT_NEAR(rear[0].stamp, 1000.1, 1e-4);

    outcome = slam(arguments + " --sensor left");
    EXPECT_EQ(outcome.exitCode, 1);
    expectHas(outcome.err, "no scans of a sensor left, but of front, rear");
}

TEST_F(Slam, ResumesARunThatWasKilled) {
    const std::vector<Pose> truth = walkAround(0.1, 0.12);
    ASSERT_EQ(slam(recordWalk(truth, "whole")).exitCode, 0);
    const std::string arguments = recordWalk(truth);
    killWhenSaved(arguments, "out/unfinished/state");

    // Of another run, nothing is mixed in.
    const Outcome other = slam(arguments + " --from 1");
    EXPECT_EQ(other.exitCode, 1);
    expectHas(other.err, "out/unfinished: holds a run that was not finished");
    expectHas(other.err, "another --from");
    EXPECT_FALSE(std::filesystem::exists(path("out/map.hgmm")));

    const Outcome outcome = slam(arguments);
    ASSERT_EQ(outcome.exitCode, 0) << outcome.err;
    expectHas(outcome.err, "going on after scan ");
    expectHas(outcome.out, std::to_string(truth.size()) + " scans in ");
    for (const std::string name : {"map.hgmm", "trajectory.tum", "graph.g2o"})
        EXPECT_EQ(content("out/" + name), content("whole/" + name)) << name;
    EXPECT_FALSE(std::filesystem::exists(path("out/unfinished")));

    killWhenSaved(arguments, "out/unfinished/state");
    std::ofstream(path("out/unfinished/submap-0"), std::ios::app) << "damaged";
    const Outcome anew = slam(arguments + " --from 1 --restart");
    ASSERT_EQ(anew.exitCode, 0) << anew.err;
    EXPECT_EQ(anew.err.find("going on"), std::string::npos);
    EXPECT_FALSE(std::filesystem::exists(path("out/unfinished")));
}

TEST_F(Slam, GoesOnFromAnEarlierMapInItsFrame) {
    const std::vector<Pose> lap = walkAround(0.1, 0.2);
    const std::vector<Pose> first(lap.begin(), lap.begin() + 70);
    // From an unknown start, back to where the first session came from.
    std::vector<Pose> second;
    for (std::size_t i = lap.size(); i-- > 25;)
        second.push_back({lap[i].R * hgmm::slam::rotationOf({0, 0, M_PI}), lap[i].t});
    ASSERT_EQ(slam(recordWalk(first)).exitCode, 0);
    const std::string map = content("out/map.hgmm");
    const Outcome outcome = slam(recordWalk(second, "more") + goingOnFrom("out"));
    ASSERT_EQ(outcome.exitCode, 0) << outcome.err;
    expectHas(outcome.out, "goes on from");
    EXPECT_EQ(content("out/map.hgmm"), map);

    const Trajectory trajectory =
        hgmm::evaluation::readTrajectory(path("more/trajectory.tum"));
    ASSERT_EQ(trajectory.size(), second.size());
    for (std::size_t i = 0; i < second.size(); ++i) {
        const Pose truth = first[0].inverse() * second[i];
        EXPECT_LT((trajectory[i].T_world_frame.t - truth.t).norm(), 0.15) << i;
        EXPECT_LT(hgmm::slam::errorOf(trajectory[i].T_world_frame, truth).head<3>().norm(),
                  0.05)
            << i;
    }
    mrpt::maps::CHGMMOccupancyMap merged;
    merged.loadFromFile(path("more/map.hgmm"));
    for (const Pose& pose : {first.front(), second.front()})
        EXPECT_GT(merged.model().occupancy((first[0].inverse() * pose).t).free, 0.5F);

    // A map goes into another folder: the earlier one may still be wanted.
    const Outcome same = slam(recordWalk(second) + goingOnFrom("out/map.hgmm"));
    EXPECT_EQ(same.exitCode, 1);
    expectHas(same.err, "map.hgmm");
    EXPECT_EQ(content("out/map.hgmm"), map);
}

TEST_F(Slam, SaysWhenARecordingIsNotOfTheEarlierMap) {
    const std::vector<Pose> lap = walkAround(0.1, 0.2);
    ASSERT_EQ(slam(recordWalk({lap.begin(), lap.begin() + 60})).exitCode, 0);
    ASSERT_EQ(replay(recordRoom() + " --save-map '" + path("room.hgmm") + "'").exitCode, 0);
    std::filesystem::create_directories(path("more"));
    std::filesystem::copy(path("out/map.hgmm"), path("more/map.hgmm"));
    const Outcome outcome = slam(recordWalk({lap.begin(), lap.begin() + 60}, "more") +
                                 goingOnFrom("room.hgmm"));
    EXPECT_EQ(outcome.exitCode, 1);
    expectHas(outcome.err, "is not known to be where");
    expectHas(outcome.err, "Nothing was written");
    EXPECT_EQ(content("more/map.hgmm"), content("out/map.hgmm"));
    EXPECT_FALSE(std::filesystem::exists(path("more/trajectory.tum")));
}

TEST_F(Slam, RefusesEarlierMapsThatAreNoneBeforeItWorks) {
    const std::string arguments = recordWalk(walkAround(0.1, 0.02));
    std::ofstream(path("notes.hgmm")) << "somebody's notes\n";
    for (const std::string name : {"none", "notes.hgmm"}) {
        const Outcome outcome = slam(arguments + goingOnFrom(name));
        EXPECT_EQ(outcome.exitCode, 1);
        expectHas(outcome.err, name);
        EXPECT_EQ(outcome.err.find("scans/s"), std::string::npos);
    }
    EXPECT_EQ(slam(arguments + goingOnFrom("notes.hgmm") + " --config x.ini").exitCode, 2);
}

TEST_F(Slam, RefusesBadInputBeforeItWorks) {
    const std::string arguments = recordWalk(walkAround(0.1, 0.02));
    EXPECT_EQ(slam("").exitCode, 2);
    EXPECT_EQ(slam("/none.rawlog -o " + path("out")).exitCode, 1);
    std::filesystem::create_directories(path("out"));
    std::ofstream(path("out/map.hgmm")) << "somebody's notes\n";
    const Outcome outcome = slam(arguments);
    EXPECT_EQ(outcome.exitCode, 1);
    expectHas(outcome.err, "map.hgmm");
    EXPECT_EQ(content("out/map.hgmm"), "somebody's notes\n");
    EXPECT_EQ(outcome.out, "");
}

}  // namespace
