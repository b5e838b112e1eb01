#include "hgmm/slam/uncertain_pose.h"

#include <Eigen/Cholesky>
#include <Eigen/Geometry>

namespace hgmm::slam {
namespace {

/// [a]x, the matrix of the cross product a x b.
Eigen::Matrix3d crossMatrix(const Eigen::Vector3d& a) {
    Eigen::Matrix3d m;
    m << 0, -a.z(), a.y(), a.z(), 0, -a.x(), -a.y(), a.x(), 0;
    return m;
}

constexpr double kMicron2 = 1e-12;  // [m^2], and [rad^2]

}  // namespace

UncertainPose UncertainPose::operator*(const UncertainPose& T_b_c) const {
    Matrix6d byFirst = Matrix6d::Identity(), bySecond = Matrix6d::Zero();
    byFirst.bottomLeftCorner<3, 3>() = -crossMatrix(T_a_b.R * T_b_c.T_a_b.t);
    bySecond.topLeftCorner<3, 3>() = bySecond.bottomRightCorner<3, 3>() = T_a_b.R;
    return {T_a_b * T_b_c.T_a_b, byFirst * covariance * byFirst.transpose() +
                                     bySecond * T_b_c.covariance * bySecond.transpose()};
}

UncertainPose UncertainPose::inverse() const {
    const Eigen::Matrix3d back = T_a_b.R.transpose();
    Matrix6d by = Matrix6d::Zero();
    by.topLeftCorner<3, 3>() = by.bottomRightCorner<3, 3>() = -back;
    by.bottomLeftCorner<3, 3>() = -back * crossMatrix(T_a_b.t);
    return {T_a_b.inverse(), by * covariance * by.transpose()};
}

Eigen::Matrix3d rotationOf(const Eigen::Vector3d& w) {
    const double angle = w.norm();
    if (angle < 1e-12) return Eigen::Matrix3d::Identity() + crossMatrix(w);
    return Eigen::AngleAxisd(angle, w / angle).toRotationMatrix();
}

Eigen::Vector3d rotationVectorOf(const Eigen::Matrix3d& R) {
    const Eigen::AngleAxisd turn(R);
    return turn.angle() * turn.axis();
}

Eigen::Matrix3d orthonormal(const Eigen::Matrix3d& R) {
    return Eigen::Quaterniond(R).normalized().toRotationMatrix();
}

Vector6d errorOf(const Pose& actual, const Pose& expected) {
    Vector6d error;
    error << rotationVectorOf(actual.R * expected.R.transpose()), actual.t - expected.t;
    return error;
}

Pose displacedBy(const Pose& pose, const Vector6d& error) {
    return {orthonormal(rotationOf(error.head<3>()) * pose.R), pose.t + error.tail<3>()};
}

double squaredMahalanobis(const Vector6d& error, const Matrix6d& covariance) {
    const Eigen::Matrix<double, 6, 6> widened =
        covariance + kMicron2 * Matrix6d::Identity();
    return error.dot(widened.ldlt().solve(Eigen::Matrix<double, 6, 1>(error)));
}

}  // namespace hgmm::slam
