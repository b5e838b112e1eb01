#include "hgmm/evaluation/recording.h"

#include <mrpt/img/CImage.h>
#include <mrpt/obs/CActionCollection.h>
#include <mrpt/obs/CObservationOdometry.h>
#include <mrpt/obs/CRawlog.h>
#include <mrpt/obs/CSensoryFrame.h>

#include <algorithm>
#include <cstdio>
#include <stdexcept>

#include "hgmm/evaluation/trajectory.h"
#include "hgmm/mrpt_bridge/observation_to_scan.h"

namespace hgmm::evaluation {
namespace {

using mrpt::poses::CPose3D;
using mrpt::serialization::CSerializable;

double timeOf(const mrpt::obs::CObservation& observation) {
    return mrpt::Clock::toDouble(observation.timestamp);
}

/// Calls visit for the range scans in an entry, in order.
template <typename Visitor>
void visitScans(const CSerializable::Ptr& entry, Visitor&& visit) {
    if (auto observation = std::dynamic_pointer_cast<mrpt::obs::CObservation>(entry)) {
        if (mrpt_bridge::isSupported(*observation)) visit(observation);
    } else if (auto frame = std::dynamic_pointer_cast<mrpt::obs::CSensoryFrame>(entry)) {
        for (const auto& o : *frame)
            if (mrpt_bridge::isSupported(*o)) visit(o);
    }
}

std::string joined(const std::set<std::string>& words) {
    std::string text;
    for (const std::string& word : words) text += (text.empty() ? "" : ", ") + word;
    return text;
}

std::string span(double from_s, double to_s) {
    char text[96];
    std::snprintf(text, sizeof text, "%.3f to %.3f s", from_s, to_s);
    return text;
}

}  // namespace

/// What the first pass over the file finds.
struct Recording::Survey {
    std::vector<double> times_s;    // of the scans within from..to
    std::vector<CPose3D> composed;  // their poses by the motions before them
    Trajectory odometry;            // readings, observation format
    std::size_t scans = 0;          // all of them
    bool hasMotion = false;

    void addMotion(const CSerializable::Ptr& entry, CPose3D& pose) {
        if (auto actions = std::dynamic_pointer_cast<mrpt::obs::CActionCollection>(entry)) {
            CPose3D increment;
            if (!actions->getFirstMovementEstimationMean(increment)) return;
            pose = pose + increment;
            hasMotion = true;
        } else if (auto reading =
                       std::dynamic_pointer_cast<mrpt::obs::CObservationOdometry>(entry)) {
            odometry.push_back(
                {timeOf(*reading), mrpt_bridge::toPose(CPose3D(reading->odometry))});
        }
    }
};

Recording::Recording(const std::string& file, const RecordingOptions& options)
    : file_(file), options_(options), reader_(file) {
    // Depth images may lie beside the rawlog; MRPT finds them through this setting only.
    mrpt::img::CImage::setImagesPathBase(mrpt::obs::CRawlog::detectImagesDirectory(file));

    Survey survey;
    RawlogReader reader(file);
    CPose3D pose;
    std::deque<mrpt::obs::CObservation::Ptr> scans;
    while (const CSerializable::Ptr entry = reader.next()) {
        survey.addMotion(entry, pose);
        visitScans(entry, [&](const auto& o) { sensorLabels_.insert(o->sensorLabel); });
        collectScans(entry, scans);
        for (; !scans.empty(); scans.pop_front()) {
            const std::size_t index = survey.scans++;
            if (index < options.from || index > options.to) continue;
            if (survey.times_s.empty())
                sensor_ = scans.front()->GetRuntimeClass()->className;
            survey.times_s.push_back(timeOf(*scans.front()));
            survey.composed.push_back(pose);
        }
    }
    if (!reader.damage().empty())
        damage_ =
            reader.damage() + "; " + std::to_string(survey.scans) + " scans can be used";
    if (survey.scans == 0 && !sensorLabels_.empty())
        throw std::runtime_error(file + ": holds no scans of a sensor " +
                                 options.sensorLabel.value_or("") + ", but of " +
                                 joined(sensorLabels_));
    if (survey.scans == 0)
        throw std::runtime_error(damage_.empty()
                                     ? file + ": holds no range scans among its " +
                                           std::to_string(reader.entries()) + " entries"
                                     : damage_ + "; is it a rawlog?");
    if (survey.times_s.empty())
        throw std::runtime_error(file + ": holds " + std::to_string(survey.scans) +
                                 " scans, so none lies between --from " +
                                 std::to_string(options.from) + " and --to");
    resolvePoses(survey);
}

void Recording::collectScans(const CSerializable::Ptr& entry,
                             std::deque<mrpt::obs::CObservation::Ptr>& scans) const {
    visitScans(entry, [&](const mrpt::obs::CObservation::Ptr& o) {
        if (!options_.sensorLabel || o->sensorLabel == *options_.sensorLabel)
            scans.push_back(o);
    });
}

void Recording::resolvePoses(const Survey& survey) {
    if (options_.posesFile) {
        posesFromFile(survey);
    } else if (survey.hasMotion) {
        poseSource_ = PoseSource::odometry;
        T_map_robot_ = survey.composed;
    } else if (!survey.odometry.empty()) {
        poseSource_ = PoseSource::odometry;
        Trajectory odometry = survey.odometry;
        std::stable_sort(odometry.begin(), odometry.end(),
                         [](const auto& a, const auto& b) { return a.stamp < b.stamp; });
        for (const double time_s : survey.times_s)
            T_map_robot_.push_back(mrpt_bridge::toCPose3D(
                *poseAt(odometry, time_s, std::numeric_limits<double>::infinity())));
    } else if (survey.scans == 1 || !options_.posesRequired) {
        T_map_robot_ = survey.composed;
    } else {
        throw std::runtime_error(
            file_ + ": holds " + std::to_string(survey.scans) +
            " scans but neither actions nor odometry that say where they "
            "were taken; give the robot's poses with --poses FILE");
    }
}

void Recording::posesFromFile(const Survey& survey) {
    poseSource_ = PoseSource::file;
    const Trajectory poses = readTrajectory(*options_.posesFile);
    std::size_t missing = 0;
    for (const double time_s : survey.times_s) {
        const std::optional<Pose> pose = poseAt(poses, time_s, kMaxPoseGap_s);
        missing += pose ? 0 : 1;
        T_map_robot_.push_back(mrpt_bridge::toCPose3D(pose.value_or(Pose{})));
    }
    if (missing == 0) return;
    const auto [first, last] =
        std::minmax_element(survey.times_s.begin(), survey.times_s.end());
    char gap[32];
    std::snprintf(gap, sizeof gap, "%g s", kMaxPoseGap_s);
    throw std::runtime_error(*options_.posesFile + ": " + std::to_string(missing) + " of " +
                             std::to_string(survey.times_s.size()) +
                             " scans have no pose within " + gap + "; the scans span " +
                             span(*first, *last) + ", the poses " +
                             span(poses.front().stamp, poses.back().stamp) +
                             ". Give the poses of this recording, or choose the scans they "
                             "cover with --from and --to");
}

std::optional<RecordedScan> Recording::next() {
    while (nextIndex_ <= options_.to) {
        while (pending_.empty()) {
            const CSerializable::Ptr entry = reader_.next();
            if (!entry) return std::nullopt;
            collectScans(entry, pending_);
        }
        RecordedScan scan;
        scan.index = nextIndex_++;
        scan.observation = pending_.front();
        pending_.pop_front();
        if (scan.index < options_.from) continue;
        scan.time_s = timeOf(*scan.observation);
        scan.T_map_robot = T_map_robot_[scan.index - options_.from];
        return scan;
    }
    return std::nullopt;
}

}  // namespace hgmm::evaluation
