#include "localiser.h"

#include "hgmm/global_search.h"

namespace localise {

namespace {

/// After so many lost scans the map is searched, and then every so many.
constexpr int kPatience = 3, kSearchEvery = 10;
/// A start that is given may be off by this [m], [rad].
constexpr double kStart_m = 0.5, kStart_rad = 0.2;

hgmm::Registration::Covariance startCovariance() {
    hgmm::Registration::Covariance covariance = hgmm::Registration::Covariance::Zero();
    for (int i = 0; i < 3; ++i) {
        covariance(i, i) = kStart_rad * kStart_rad;
        covariance(3 + i, 3 + i) = kStart_m * kStart_m;
    }
    return covariance;
}

/// The robot's pose from its sensor's. The covariance is that of (w, v), and a turn of the
/// sensor swings the robot about it: v' = v + w x (t_robot - t_sensor).
hgmm::TrackedPose robotPose(hgmm::TrackedPose pose, const hgmm::Pose& T_robot_sensor) {
    const Eigen::Vector3d sensor = pose.T_map_sensor.t;
    pose.T_map_sensor = pose.T_map_sensor * T_robot_sensor.inverse();
    const Eigen::Vector3d arm = pose.T_map_sensor.t - sensor;
    Eigen::Matrix<double, 6, 6> J = Eigen::Matrix<double, 6, 6>::Identity();
    J.bottomLeftCorner<3, 3>() << 0, arm.z(), -arm.y(), -arm.z(), 0, arm.x(), arm.y(),
        -arm.x(), 0;
    const Eigen::Matrix<double, 6, 6> covariance = pose.covariance;
    pose.covariance = J * covariance * J.transpose();
    return pose;
}

}  // namespace

Localiser::Localiser(std::shared_ptr<const hgmm::Map> map,
                     const std::optional<hgmm::Pose>& start)
    : map_(std::move(map)), start_(start) {}

bool Localiser::search(const TimedScan& timed) {
    const auto found = hgmm::findInMap(*map_, hgmm::samplesOf(timed.scan, map_->params()));
    if (found) tracker_.emplace(map_, *found);
    return found.has_value();
}

hgmm::TrackedPose Localiser::next(const TimedScan& timed) {
    const bool first = !tracker_ && start_;
    if (first) {
        hgmm::PoseEstimate estimate;
        estimate.T_map_sensor = *start_ * timed.scan.T_map_sensor;
        estimate.covariance = startCovariance();
        tracker_.emplace(map_, estimate);
    }
    const bool due =
        lostScans_ >= kPatience && (lostScans_ - kPatience) % kSearchEvery == 0;
    const bool unknown = !tracker_ && lostScans_ % kSearchEvery == 0;
    const bool found = (due || unknown) && search(timed);
    hgmm::TrackedPose pose;
    pose.lost = true;
    if (tracker_)
        pose = tracker_->track(timed.scan, timed.time_s,
                               found || first ? std::nullopt : timed.odometry);
    lostScans_ = pose.lost ? lostScans_ + 1 : 0;
    return robotPose(pose, timed.scan.T_map_sensor);
}

}  // namespace localise
