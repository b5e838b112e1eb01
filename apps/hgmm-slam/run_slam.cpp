#include "run_slam.h"

#include <hgmm/mrpt_bridge/observation_to_scan.h>
#include <hgmm/slam/odometry.h>
#include <omp.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <future>
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

/// Scans of one recording on their way through odometry into the map. Where there are
/// threads, a scan enters the map on one of its own while the next is followed.
class Follower {
 public:
    Follower(const MapParams& map, const mrpt_bridge::ReadingParams& reading,
             bool posesAreOdometry)
        : map_(map),
          reading_(reading),
          posesAreOdometry_(posesAreOdometry),
          slam_(std::make_unique<slam::SubmapSlam>(map)),
          threads_(omp_get_max_threads()),
          launch_(threads_ > 1 ? std::launch::async : std::launch::deferred) {
        omp_set_num_threads(std::max(1, threads_ - 1));
    }

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
        stamps_.push_back(recorded.time_s);
        waitForInsertion();
        insertion_ = std::async(launch_, [this, step, samples = odometry_->lastSamples(),
                                          held = odometry_->held()] {
            if (launch_ == std::launch::async) omp_set_num_threads(1);
            if (held)
                slam_->add(samples, T_robot_sensor_, step);
            else
                slam_->addLost(step);
        });
    }

    std::string news() const {
        char text[96];
        std::snprintf(text, sizeof text, ", %zu submaps, %zu loops%s", submaps_, closures_,
                      odometry_->lost() ? ", lost" : "");
        return text;
    }

    SlamRun finish() && {
        waitForInsertion();
        slam_->finish();
        omp_set_num_threads(threads_);
        SlamRun run;
        const std::vector<Pose> poses = slam_->trajectory();
        for (std::size_t i = 0; i < poses.size(); ++i)
            run.trajectory.push_back({stamps_[i], poses[i]});
        run.scansLost = lost_;
        run.slam = std::move(slam_);
        return run;
    }

 private:
    void waitForInsertion() {
        if (!insertion_.valid()) return;
        insertion_.get();
        submaps_ = slam_->submaps();
        closures_ = slam_->closures();
    }

    MapParams map_;
    mrpt_bridge::ReadingParams reading_;
    bool posesAreOdometry_;
    std::unique_ptr<slam::SubmapSlam> slam_;
    std::optional<slam::Odometry> odometry_;
    Pose T_robot_sensor_, T_given_last_;
    double time_s_ = 0.0;  // of the last scan, never going back
    std::vector<double> stamps_;
    std::size_t lost_ = 0;
    std::size_t submaps_ = 0, closures_ = 0;  // before the insertion at hand
    int threads_;
    std::launch launch_;
    std::future<void> insertion_;  // the last: it uses the members above
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
