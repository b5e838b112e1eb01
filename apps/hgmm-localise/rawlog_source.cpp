#include <algorithm>
#include <cstdio>

#include "hgmm/evaluation/recording.h"
#include "hgmm/mrpt_bridge/observation_to_scan.h"
#include "hgmm/slam/odometry.h"
#include "interrupt.h"
#include "scan_source.h"

namespace localise {

namespace {

using hgmm::evaluation::PoseSource;
using hgmm::evaluation::Recording;
using hgmm::evaluation::RecordingOptions;

RecordingOptions ofOneSensor(const std::string& file,
                             const std::optional<std::string>& sensorLabel) {
    RecordingOptions options;
    options.posesRequired = false;
    options.sensorLabel = sensorLabel;
    if (sensorLabel) return options;
    Recording all(file, options);
    if (all.sensorLabels().size() < 2) return options;
    options.sensorLabel = all.next()->observation->sensorLabel;
    std::fprintf(stderr, "warning: scans of %zu sensors; using those of %s (--sensor)\n",
                 all.sensorLabels().size(), options.sensorLabel->c_str());
    return options;
}

class RawlogSource : public ScanSource {
 public:
    RawlogSource(const std::string& file, const std::optional<std::string>& sensorLabel)
        : recording_(file, ofOneSensor(file, sensorLabel)) {
        if (!recording_.damage().empty())
            std::fprintf(stderr, "warning: %s\n", recording_.damage().c_str());
    }

    std::optional<TimedScan> next() override {
        if (replay::interrupted()) return {};
        const auto recorded = recording_.next();
        if (!recorded) return {};
        TimedScan timed;
        time_s_ = std::max(time_s_, recorded->time_s);
        timed.time_s = time_s_;
        // An observation that holds nothing makes an empty scan.
        timed.scan =
            hgmm::mrpt_bridge::observationToScan(*recorded->observation, std::nullopt,
                                                 hgmm::mrpt_bridge::Channels::none)
                .value_or(hgmm::Scan());
        timed.scan.T_map_sensor =
            hgmm::mrpt_bridge::sensorPoseInMap(*recorded->observation, std::nullopt);
        const hgmm::Pose T_odometry_sensor =
            hgmm::mrpt_bridge::toPose(recorded->T_map_robot) * timed.scan.T_map_sensor;
        if (T_odometry_last_ && recording_.poseSource() == PoseSource::odometry) {
            const auto motion =
                hgmm::slam::givenMotion(T_odometry_last_->inverse() * T_odometry_sensor);
            timed.odometry = {motion.T_a_b, motion.covariance};
        }
        T_odometry_last_ = T_odometry_sensor;
        return timed;
    }

 private:
    Recording recording_;
    std::optional<hgmm::Pose> T_odometry_last_;  // of the sensor
    double time_s_ = 0.0;                        // of the last scan, never going back
};

}  // namespace

std::unique_ptr<ScanSource> openRawlog(const std::string& file,
                                       const std::optional<std::string>& sensorLabel) {
    return std::make_unique<RawlogSource>(file, sensorLabel);
}

}  // namespace localise
