#include "localiser.h"

#include <utility>

#include "hgmm/global_search.h"
#include "hgmm/slam/uncertain_pose.h"

namespace localise {

namespace {

/// The map is searched after so many doubtful scans, and then every so many.
constexpr int kPatience = 3, kSearchEvery = 10;
/// A scan is doubtful where less of it lies on surfaces, and so many times as much of it is
/// in space that is known to be free [1]. Where the pose is right and nothing has moved, it
/// is .7 and more, and .12 at most.
constexpr double kLittle = 0.55, kContradicted = 0.3;
/// A start that is given may be off by this [m], [rad].
constexpr double kStart_m = 0.5, kStart_rad = 0.2;

hgmm::Registration::Covariance startCovariance() {
    hgmm::Registration::Covariance covariance = hgmm::Registration::Covariance::Zero();
    covariance.topLeftCorner<3, 3>().diagonal().setConstant(kStart_rad * kStart_rad);
    covariance.bottomRightCorner<3, 3>().diagonal().setConstant(kStart_m * kStart_m);
    return covariance;
}

/// The robot's pose from its sensor's.
hgmm::TrackedPose robotPose(hgmm::TrackedPose pose, const hgmm::Pose& T_robot_sensor) {
    const hgmm::slam::UncertainPose T_map_robot =
        hgmm::slam::UncertainPose{pose.T_map_sensor, pose.covariance} *
        hgmm::slam::UncertainPose{T_robot_sensor.inverse()};
    pose.T_map_sensor = T_map_robot.T_a_b;
    pose.covariance = T_map_robot.covariance;
    return pose;
}

/// @param before whether the robot was lost at the scan before: it is found again where
/// the map explains much.
bool isDoubtful(const std::optional<hgmm::TrackedPose>& pose, bool before) {
    if (!pose || pose->lost) return true;
    return pose->overlap < kLittle &&
           (before || pose->contradicted > kContradicted * pose->overlap);
}

}  // namespace

Localiser::Localiser(std::shared_ptr<const hgmm::Map> map,
                     const std::optional<hgmm::Pose>& start)
    : map_(std::move(map)), start_(start) {}

bool Localiser::beginAtStart(const TimedScan& timed) {
    if (tracker_ || !start_) return false;
    hgmm::PoseEstimate estimate;
    estimate.T_map_sensor = *start_ * timed.scan.T_map_sensor;
    estimate.covariance = startCovariance();
    tracker_.emplace(map_, estimate);
    return true;
}

bool Localiser::searchIsDue() const {
    const int patience = tracker_ ? kPatience : 0;
    return doubtfulScans_ >= patience && (doubtfulScans_ - patience) % kSearchEvery == 0;
}

bool Localiser::search(const TimedScan& timed) {
    const auto found = hgmm::findInMap(*map_, hgmm::samplesOf(timed.scan, map_->params()));
    if (found) tracker_.emplace(map_, *found);
    return found.has_value();
}

std::optional<hgmm::TrackedPose> Localiser::next(const TimedScan& timed) {
    const bool moved = beginAtStart(timed) || (searchIsDue() && search(timed));
    std::optional<hgmm::TrackedPose> pose;
    if (tracker_)
        pose = robotPose(tracker_->track(timed.scan, timed.time_s,
                                         moved ? std::nullopt : timed.odometry),
                         timed.scan.T_map_sensor);
    doubtfulScans_ = isDoubtful(pose, doubtfulScans_ >= kPatience) ? doubtfulScans_ + 1 : 0;
    if (pose) pose->lost = pose->lost || doubtfulScans_ >= kPatience;
    return pose;
}

}  // namespace localise
