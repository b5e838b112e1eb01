#include "tracking/motion.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

namespace hgmm {

namespace {

/// The deviation is at least this [m], [rad]: what a smooth motion may bring.
constexpr SearchRadius kLeast{0.05, 0.01};
/// It forgets what is longer ago than about so many scans.
constexpr int kMemory = 30;
/// Variance of motions out of the plane of a planar laser [m^2], [rad^2]: of rounding.
constexpr double kOutOfPlane2 = 1e-10;
/// Until so many scans have taught it, the first deviation counts as well.
constexpr int kFewScans = 3;

}  // namespace

Eigen::Vector3d rotationVector(const Eigen::Matrix3d& R) {
    const Eigen::AngleAxisd turned(R);
    return turned.angle() * turned.axis();
}

bool isFarFrom(const Pose& a, const Pose& b, const SearchRadius& most) {
    return (a.t - b.t).norm() > most.width_m ||
           rotationVector(a.R.transpose() * b.R).norm() > most.angle_rad;
}

Eigen::Matrix3d orthonormal(const Eigen::Matrix3d& R) {
    return Eigen::Quaterniond(R).normalized().toRotationMatrix();
}

Velocity Velocity::of(const Pose& T_before_after, double duration_s) {
    return {rotationVector(T_before_after.R) / duration_s, T_before_after.t / duration_s};
}

Pose Velocity::after(double duration_s) const {
    return {rotationOf(duration_s * angular), duration_s * linear};
}

Registration::Covariance inPlaneOfRays(const Registration::Covariance& covariance,
                                       const Eigen::Vector3d& normalOfRays) {
    if (normalOfRays.isZero()) return covariance;
    Matrix6d inPlane = Matrix6d::Zero();
    inPlane.topLeftCorner<3, 3>() = normalOfRays * normalOfRays.transpose();
    inPlane.bottomRightCorner<3, 3>() =
        Eigen::Matrix3d::Identity() - normalOfRays * normalOfRays.transpose();
    return inPlane * Matrix6d(covariance) * inPlane + kOutOfPlane2 * Matrix6d::Identity();
}

PoseEstimate compose(const PoseEstimate& last, const MotionIncrement& motion) {
    const Eigen::Matrix3d& R = last.T_map_sensor.R;
    // A turn of the last pose swings the next one about it.
    Matrix6d ofLast = Matrix6d::Identity();
    ofLast.bottomLeftCorner<3, 3>() = -crossMatrix(R * motion.T_last_now.t);
    Matrix6d ofMotion = Matrix6d::Zero();
    ofMotion.topLeftCorner<3, 3>() = R;
    ofMotion.bottomRightCorner<3, 3>() = R;
    PoseEstimate next;
    next.T_map_sensor = last.T_map_sensor * motion.T_last_now;
    next.T_map_sensor.R = orthonormal(next.T_map_sensor.R);
    next.covariance = ofLast * Matrix6d(last.covariance) * ofLast.transpose() +
                      ofMotion * Matrix6d(motion.covariance) * ofMotion.transpose();
    return next;
}

Scan motionTakenOut(const Scan& scan, const std::vector<float>& pointTimes_s,
                    const Velocity& velocity) {
    Scan still = scan;
    for (std::size_t i = 0; i < still.size(); ++i) {
        const Pose T_now_point = velocity.after(double(pointTimes_s[i]));
        const Eigen::Vector3d p =
            T_now_point.R * Eigen::Vector3d(scan.x[i], scan.y[i], scan.z[i]) +
            T_now_point.t;
        still.x[i] = static_cast<float>(p.x());
        still.y[i] = static_cast<float>(p.y());
        still.z[i] = static_cast<float>(p.z());
    }
    return still;
}

SearchRadius PriorDeviation::now() const {
    if (count_ == 0) return first_;
    SearchRadius learnt{std::sqrt(squared_m2_), std::sqrt(squared_rad2_)};
    if (count_ < kFewScans) {
        learnt.width_m = std::max(learnt.width_m, first_.width_m / (1 + count_));
        learnt.angle_rad = std::max(learnt.angle_rad, first_.angle_rad / (1 + count_));
    }
    return {std::max(kLeast.width_m, learnt.width_m),
            std::max(kLeast.angle_rad, learnt.angle_rad)};
}

void PriorDeviation::learn(const Pose& prior, const Pose& found) {
    count_ = std::min(count_ + 1, kMemory);
    const double off_m = (found.t - prior.t).norm();
    const double off_rad = rotationVector(found.R * prior.R.transpose()).norm();
    squared_m2_ += (off_m * off_m - squared_m2_) / count_;
    squared_rad2_ += (off_rad * off_rad - squared_rad2_) / count_;
}

}  // namespace hgmm
