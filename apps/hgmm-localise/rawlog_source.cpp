#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "hgmm/evaluation/recording.h"
#include "hgmm/mrpt_bridge/observation_to_scan.h"
#include "scan_source.h"

namespace localise {

namespace {

using hgmm::evaluation::PoseSource;
using hgmm::evaluation::Recording;
using hgmm::evaluation::RecordingOptions;

/// Odometry is off by this share of the way and of the turn, and by this much at least [m],
/// [rad].
constexpr double kOff = 0.1, kLeast_m = 0.02, kLeast_rad = 0.01;

RecordingOptions withoutPoses() {
    RecordingOptions options;
    options.posesRequired = false;
    return options;
}

hgmm::MotionIncrement motionBetween(const hgmm::Pose& before, const hgmm::Pose& after) {
    hgmm::MotionIncrement motion;
    motion.T_last_now = before.inverse() * after;
    const double way_m = motion.T_last_now.t.norm();
    const double turn_rad =
        std::acos(std::clamp((motion.T_last_now.R.trace() - 1.0) / 2.0, -1.0, 1.0));
    const double std_m = std::max(kLeast_m, kOff * way_m);
    const double std_rad = std::max(kLeast_rad, kOff * turn_rad);
    motion.covariance.setZero();
    for (int i = 0; i < 3; ++i) {
        motion.covariance(i, i) = std_rad * std_rad;
        motion.covariance(3 + i, 3 + i) = std_m * std_m;
    }
    return motion;
}

class RawlogSource : public ScanSource {
 public:
    RawlogSource(const std::string& file, std::string sensorLabel)
        : file_(file),
          sensorLabel_(std::move(sensorLabel)),
          recording_(file, withoutPoses()) {}

    std::optional<TimedScan> next() override {
        while (const auto recorded = recording_.next()) {
            if (!sensorLabel_.empty() && recorded->observation->sensorLabel != sensorLabel_)
                continue;
            auto scan = hgmm::mrpt_bridge::observationToScan(
                *recorded->observation, std::nullopt, hgmm::mrpt_bridge::Channels::none);
            if (!scan || scan->size() == 0) continue;
            return withOdometry(recorded->time_s,
                                hgmm::mrpt_bridge::toPose(recorded->T_map_robot),
                                std::move(*scan));
        }
        if (last_) return {};
        throw std::runtime_error(
            file_ + ": no scans" +
            (sensorLabel_.empty() ? "" : " of sensor " + sensorLabel_));
    }

 private:
    TimedScan withOdometry(double time_s, const hgmm::Pose& T_odometry_robot,
                           hgmm::Scan scan) {
        TimedScan timed{time_s, std::move(scan), {}};
        const hgmm::Pose T_odometry_sensor = T_odometry_robot * timed.scan.T_map_sensor;
        if (last_ && recording_.poseSource() == PoseSource::odometry)
            timed.odometry = motionBetween(*last_, T_odometry_sensor);
        last_ = T_odometry_sensor;
        return timed;
    }

    std::string file_;
    std::string sensorLabel_;
    Recording recording_;
    std::optional<hgmm::Pose> last_;  ///< of the sensor, by odometry
};

}  // namespace

std::unique_ptr<ScanSource> openRawlog(const std::string& file,
                                       const std::string& sensorLabel) {
    return std::make_unique<RawlogSource>(file, sensorLabel);
}

}  // namespace localise
