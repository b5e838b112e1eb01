#include "run_slam.h"

#include <hgmm/mrpt_bridge/observation_to_scan.h>
#include <hgmm/slam/odometry.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <stdexcept>
#include <string>
#include <utility>

#include "interrupt.h"
#include "progress.h"

namespace hgmm::slam_app {
namespace {

using evaluation::PoseSource;
using evaluation::RecordedScan;
using evaluation::Recording;
using Clock = std::chrono::steady_clock;

/// Scans of one recording on their way through odometry into the map.
class Follower {
 public:
    Follower(const MapParams& map, const mrpt_bridge::ReadingParams& reading,
             bool posesAreOdometry)
        : map_(map),
          reading_(reading),
          posesAreOdometry_(posesAreOdometry),
          slam_(std::make_unique<slam::SubmapSlam>(map)) {}

    void follow(const RecordedScan& recorded) {
        // Of an observation that holds nothing, only the time is known.
        Scan scan = mrpt_bridge::observationToScan(*recorded.observation, std::nullopt,
                                                   mrpt_bridge::Channels::none, reading_)
                        .value_or(Scan{});
        if (!odometry_) {
            T_robot_sensor_ =
                mrpt_bridge::sensorPoseInMap(*recorded.observation, std::nullopt);
            odometry_.emplace(map_, T_robot_sensor_);
        }
        const Pose T_given_robot = mrpt_bridge::toPose(recorded.T_map_robot);
        std::optional<slam::UncertainPose> motion;
        if (posesAreOdometry_)
            motion = slam::givenMotion(T_given_last_.inverse() * T_given_robot);
        T_given_last_ = T_given_robot;
        time_s_ = std::max(time_s_, recorded.time_s);
        const slam::UncertainPose step = odometry_->step(scan, time_s_, motion);
        lost_ += odometry_->lost() ? 1 : 0;
        if (odometry_->held())
            slam_->add(odometry_->lastSamples(), T_robot_sensor_, step);
        else
            slam_->addLost(step);
        stamps_.push_back(recorded.time_s);
    }

    std::string news() const {
        char text[96];
        std::snprintf(text, sizeof text, ", %zu submaps, %zu loops%s", slam_->submaps(),
                      slam_->closures(), odometry_->lost() ? ", lost" : "");
        return text;
    }

    SlamRun finish() && {
        slam_->finish();
        SlamRun run;
        const std::vector<Pose> poses = slam_->trajectory();
        for (std::size_t i = 0; i < poses.size(); ++i)
            run.trajectory.push_back({stamps_[i], poses[i]});
        run.scansLost = lost_;
        run.slam = std::move(slam_);
        return run;
    }

 private:
    MapParams map_;
    mrpt_bridge::ReadingParams reading_;
    bool posesAreOdometry_;
    std::unique_ptr<slam::SubmapSlam> slam_;
    std::optional<slam::Odometry> odometry_;
    Pose T_robot_sensor_, T_given_last_;
    double time_s_ = 0.0;  // of the last scan, never going back
    std::vector<double> stamps_;
    std::size_t lost_ = 0;
};

}  // namespace

evaluation::RecordingOptions recordingOptionsFor(const Options& o) {
    evaluation::RecordingOptions options{o.odometry, o.from, o.to, false, o.sensorLabel};
    if (o.sensorLabel) return options;
    Recording all(o.log, options);
    if (all.sensorLabels().size() < 2) return options;
    options.sensorLabel = all.next()->observation->sensorLabel;
    std::fprintf(stderr, "warning: scans of %zu sensors; using those of %s (--sensor)\n",
                 all.sensorLabels().size(), options.sensorLabel->c_str());
    return options;
}

SlamRun runSlam(Recording& recording, const MapParams& map,
                const mrpt_bridge::ReadingParams& reading, const Options& options) {
    const bool posesAreOdometry =
        recording.poseSource() == PoseSource::file ||
        (recording.poseSource() == PoseSource::odometry && !options.ignoreOdometry);
    Follower follower(map, reading, posesAreOdometry);
    const Clock::time_point start = Clock::now();
    replay::Progress progress(recording.size(), options.quiet);
    bool stopped = false;
    while (const std::optional<RecordedScan> recorded = recording.next()) {
        follower.follow(*recorded);
        progress.advance(follower.news());
        stopped = replay::interrupted();
        if (stopped) break;
    }
    SlamRun run = std::move(follower).finish();
    run.seconds = std::chrono::duration<double>(Clock::now() - start).count();
    run.interrupted = stopped;
    return run;
}

}  // namespace hgmm::slam_app
