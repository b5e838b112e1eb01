#pragma once
#include <Eigen/Core>

#include "hgmm/scan.h"

namespace hgmm::slam {

using Vector6d = Eigen::Matrix<double, 6, 1, Eigen::DontAlign>;
using Matrix6d = Eigen::Matrix<double, 6, 6, Eigen::DontAlign>;

/// A pose T_a_b with the covariance of its error (w, v), rotation [rad] before translation
/// [m], both in the axes of a, as in Registration: truth = { exp(w) R, t + v }.
struct UncertainPose {
    Pose T_a_b;
    Matrix6d covariance = Matrix6d::Zero();  ///< positive semi-definite

    /// T_a_c, to first order in the errors, which are independent.
    UncertainPose operator*(const UncertainPose& T_b_c) const;
    /// T_b_a, to first order.
    UncertainPose inverse() const;
};

/// (w, v) of which a pose is off another: actual = { exp(w) R, t + v } of `expected`.
Vector6d errorOf(const Pose& actual, const Pose& expected);

/// The pose that is off by (w, v).
Pose displacedBy(const Pose& pose, const Vector6d& error);

/// Squared Mahalanobis distance of an error; directions without variance count as exact to
/// a micron.
double squaredMahalanobis(const Vector6d& error, const Matrix6d& covariance);

/// exp(w), and its inverse: a rotation vector [rad] of at most pi.
Eigen::Matrix3d rotationOf(const Eigen::Vector3d& w);
Eigen::Vector3d rotationVectorOf(const Eigen::Matrix3d& R);

/// The rotation next to a matrix that rounding took off.
Eigen::Matrix3d orthonormal(const Eigen::Matrix3d& R);

}  // namespace hgmm::slam
