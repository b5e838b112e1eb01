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

/// A scan of a recording, and what the map takes of it.
struct ReadScan {
    RecordedScan recorded;
    Scan scan;
};

/// Reads the next scan on a thread of its own, where there are threads, while one is
/// followed.
class ScanReader {
 public:
    ScanReader(Recording& recording, const mrpt_bridge::ReadingParams& reading)
        : recording_(recording),
          reading_(reading),
          launch_(omp_get_max_threads() > 1 ? std::launch::async : std::launch::deferred) {}

    /// Nothing at the end.
    std::optional<ReadScan> next() {
        if (!ahead_.valid()) readAhead();
        std::optional<ReadScan> scan = ahead_.get();
        if (scan) readAhead();
        return scan;
    }

 private:
    void readAhead() {
        ahead_ = std::async(launch_, [this]() -> std::optional<ReadScan> {
            std::optional<RecordedScan> recorded = recording_.next();
            if (!recorded) return std::nullopt;
            // Of an observation that holds nothing, only the time is known.
            Scan scan =
                mrpt_bridge::observationToScan(*recorded->observation, std::nullopt,
                                               mrpt_bridge::Channels::none, reading_)
                    .value_or(Scan{});
            return ReadScan{std::move(*recorded), std::move(scan)};
        });
    }

    Recording& recording_;
    mrpt_bridge::ReadingParams reading_;
    std::launch launch_;
    std::future<std::optional<ReadScan>> ahead_;  // uses the members above
};

/// Scans of one recording on their way through odometry into the map. Where there are
/// threads, a scan enters the map on one of its own while the next is followed.
class Follower {
 public:
    Follower(const MapParams& map, bool posesAreOdometry)
        : map_(map),
          posesAreOdometry_(posesAreOdometry),
          slam_(std::make_unique<slam::SubmapSlam>(map)),
          threads_(omp_get_max_threads()),
          launch_(threads_ > 1 ? std::launch::async : std::launch::deferred) {
        omp_set_num_threads(std::max(1, threads_ - 1));
    }

    /// Goes on from where a run stopped. Reads the recording up to there, for the state is
    /// without samples of scans.
    void resume(const SavedRun& saved, Checkpoint& checkpoint, ScanReader& reader) {
        odometry_ = slam::Odometry::load(saved.odometry, [&](std::size_t number) {
            std::optional<ReadScan> read;
            while (stamps_.size() <= number) {
                read = reader.next();
                if (!read) throw std::runtime_error("the recording has become shorter");
                note(read->recorded);
            }
            if (!read) throw std::runtime_error("scans are not in their order");
            return samplesOf(read->scan, map_);
        });
        slam_->load(saved.slam, [&](std::size_t k) { return checkpoint.submap(k); });
        if (stamps_.size() != saved.scans || slam_->trajectory().size() != saved.scans)
            throw std::runtime_error("its parts are of different scans");
        lost_ = saved.scansLost;
        earlier_s_ = saved.seconds;
    }

    void follow(const ReadScan& read) {
        const Pose T_given_before = T_given_last_;
        note(read.recorded);
        if (!odometry_) odometry_.emplace(map_, T_robot_sensor_);
        std::optional<slam::UncertainPose> motion;
        if (posesAreOdometry_)
            motion = slam::givenMotion(T_given_before.inverse() * T_given_last_);
        const slam::UncertainPose step = odometry_->step(read.scan, time_s_, motion);
        lost_ += odometry_->lost() ? 1 : 0;
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

    /// After a scan was followed. Returns whether the state was saved.
    bool save(Checkpoint& checkpoint) {
        waitForInsertion();
        return checkpoint.save({stamps_.size(), lost_, seconds(), {}, {}}, *odometry_,
                               *slam_);
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
        run.seconds = seconds();
        run.slam = std::move(slam_);
        return run;
    }

 private:
    /// Keeps what is needed later of a scan, in the recording's order.
    void note(const RecordedScan& recorded) {
        if (stamps_.empty())
            T_robot_sensor_ =
                mrpt_bridge::sensorPoseInMap(*recorded.observation, std::nullopt);
        T_given_last_ = mrpt_bridge::toPose(recorded.T_map_robot);
        time_s_ = std::max(time_s_, recorded.time_s);
        stamps_.push_back(recorded.time_s);
    }

    double seconds() const {
        return earlier_s_ + std::chrono::duration<double>(Clock::now() - start_).count();
    }

    void waitForInsertion() {
        if (!insertion_.valid()) return;
        insertion_.get();
        submaps_ = slam_->submaps();
        closures_ = slam_->closures();
    }

    MapParams map_;
    bool posesAreOdometry_;
    std::unique_ptr<slam::SubmapSlam> slam_;
    std::optional<slam::Odometry> odometry_;
    Pose T_robot_sensor_, T_given_last_;
    double time_s_ = 0.0;  // of the last scan, never going back
    std::vector<double> stamps_;
    std::size_t lost_ = 0;
    std::size_t submaps_ = 0, closures_ = 0;  // before the insertion at hand
    Clock::time_point start_ = Clock::now();
    double earlier_s_ = 0.0;  // that the run had taken before it stopped
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
                const mrpt_bridge::ReadingParams& reading, const Options& options,
                Checkpoint& checkpoint) {
    const bool posesAreOdometry =
        recording.poseSource() == PoseSource::file ||
        (recording.poseSource() == PoseSource::odometry && !options.ignoreOdometry);
    ScanReader reader(recording, reading);
    Follower follower(map, posesAreOdometry);
    const std::optional<SavedRun> saved = checkpoint.load();
    if (saved) {
        std::fprintf(stderr,
                     "going on after scan %zu of %zu, where a run of the same command "
                     "stopped (--restart begins anew)\n",
                     saved->scans, recording.size());
        try {
            follower.resume(*saved, checkpoint, reader);
        } catch (const std::exception& e) {
            throw std::runtime_error(checkpoint.folder() + ": " + e.what() +
                                     "; --restart discards it");
        }
    }
    replay::Progress progress(recording.size(), options.quiet, saved ? saved->scans : 0);
    bool stopped = false, canGoOn = false;
    while (const std::optional<ReadScan> read = reader.next()) {
        follower.follow(*read);
        progress.advance(follower.news());
        stopped = replay::interrupted();
        if (stopped || checkpoint.isDue()) canGoOn = follower.save(checkpoint);
        if (stopped) break;
    }
    SlamRun run = std::move(follower).finish();
    run.interrupted = stopped;
    run.canGoOn = stopped && canGoOn;
    return run;
}

}  // namespace hgmm::slam_app
