#include "hgmm/slam/odometry.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>
#include <utility>

#include "io/state_archive.h"

namespace hgmm::slam {
namespace {

/// What a covariance has grown by; directions in which it shrank have not grown.
Matrix6d growth(const Matrix6d& before, const Matrix6d& after) {
    const Eigen::Matrix<double, 6, 6> difference = after - before;
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix<double, 6, 6>> axes(difference);
    return axes.eigenvectors() * axes.eigenvalues().cwiseMax(0.0).asDiagonal() *
           axes.eigenvectors().transpose();
}

/// The same errors in other axes.
Matrix6d rotated(const Matrix6d& covariance, const Eigen::Matrix3d& R) {
    Matrix6d by = Matrix6d::Zero();
    by.topLeftCorner<3, 3>() = by.bottomRightCorner<3, 3>() = R;
    return by * covariance * by.transpose();
}

/// Errors of given motions are alike from one to the next, as of a wheel's diameter: where
/// surfaces do not hold the sensor, they add up as if they were independent from metre to
/// metre, not from scan to scan. Returns the factor of their variance.
double alikeness(const Pose& T_previous_robot) {
    constexpr double kAlike_m = 1.0, kMost = 10.0;
    const double way_m = T_previous_robot.t.norm();
    return std::clamp(kAlike_m / std::max(way_m, 1e-6), 1.0, kMost);
}

constexpr StateKind kOdometryState{{'H', 'G', 'M', 'O'}, 1, "saved odometry"};

PoseEstimate startAt(const Pose& T_map_sensor) {
    PoseEstimate start;
    start.T_map_sensor = T_map_sensor;
    return start;
}

}  // namespace

UncertainPose givenMotion(const Pose& T_previous_robot) {
    const double way_m = T_previous_robot.t.norm();
    const double turn_rad = rotationVectorOf(T_previous_robot.R).norm();
    UncertainPose motion{T_previous_robot, Matrix6d::Zero()};
    motion.covariance.topLeftCorner<3, 3>().diagonal().setConstant(
        std::pow(0.005 + 0.1 * turn_rad + 0.02 * way_m, 2));
    motion.covariance.bottomRightCorner<3, 3>().diagonal().setConstant(
        std::pow(0.01 + 0.1 * way_m, 2));
    return motion;
}

Odometry::Odometry(const MapParams& map, const Pose& T_robot_sensor)
    : T_robot_sensor_(T_robot_sensor), tracker_(map, {}, startAt(T_robot_sensor)) {}

UncertainPose Odometry::step(const Scan& scan, double time_s,
                             const std::optional<UncertainPose>& T_previous_robot) {
    std::optional<MotionIncrement> increment;
    const UncertainPose T_robot_sensor{T_robot_sensor_, Matrix6d::Zero()};
    const UncertainPose T_sensor_robot{T_robot_sensor_.inverse(), Matrix6d::Zero()};
    if (started_ && T_previous_robot) {
        const UncertainPose T_last_now =
            T_sensor_robot * *T_previous_robot * T_robot_sensor;
        increment = {T_last_now.T_a_b, T_last_now.covariance};
    }
    last_ = tracker_.track(scan, time_s, increment);
    const PoseEstimate now = last_, before = started_ ? held_ : now;
    if (held() || !started_) held_ = now;
    started_ = true;
    const double alike = increment ? alikeness(T_previous_robot->T_a_b) : 1.0;
    const UncertainPose T_before_now{
        before.T_map_sensor.inverse() * now.T_map_sensor,
        rotated(alike * growth(before.covariance, now.covariance),
                before.T_map_sensor.R.transpose())};
    return T_robot_sensor * T_before_now * T_sensor_robot;
}

template <typename Archive, typename Self>
void Odometry::archive(Archive& a, Self& self) {
    a(self.T_robot_sensor_, self.started_, self.held_.T_map_sensor, self.held_.covariance);
    auto& last = self.last_;
    a(last.T_map_sensor, last.covariance, last.overlap, last.contradicted, last.observable,
      last.lost, last.inserted);
}

std::vector<std::uint8_t> Odometry::save() const {
    StateWriter out(kOdometryState);
    archive(out, *this);
    out(tracker_.save());
    return std::move(out).finish();
}

Odometry Odometry::load(const std::vector<std::uint8_t>& state,
                        const std::function<ScanSamples(std::size_t scan)>& samplesOfScan) {
    Odometry odometry({}, {});
    std::vector<std::uint8_t> tracker;
    try {
        StateReader in(state.data(), state.size(), kOdometryState);
        archive(in, odometry);
        in(tracker);
    } catch (const std::out_of_range& e) {
        throw FormatError(std::string(kOdometryState.name) + ": " + e.what());
    }
    odometry.tracker_ = ScanTracker::load(tracker.data(), tracker.size(), samplesOfScan);
    return odometry;
}

}  // namespace hgmm::slam
