#pragma once
#include <Eigen/Core>

namespace hgmm {

using Vector6d = Eigen::Matrix<double, 6, 1>;
using Matrix6d = Eigen::Matrix<double, 6, 6>;

/// -exp(-1/2 mu^T (C + S)^-1 mu), summed over pairs of components, with derivatives by
/// (w, v), the rotation exp(w) about the source's centre and the translation v, at zero.
struct CostSums {
    double cost = 0.0;
    Vector6d gradient = Vector6d::Zero();
    Matrix6d hessian = Matrix6d::Zero();
    Matrix6d gaussNewton = Matrix6d::Zero();  ///< its positive semi-definite part
    /// gaussNewton of each pair times the square of its width: whatever the widths, a pair
    /// that faces a direction adds as much to it as to the cost, or less. Near pairs, which
    /// are narrow, would outweigh far ones in gaussNewton itself.
    Matrix6d observability = Matrix6d::Zero();

    CostSums& operator+=(const CostSums& o);
};

/// A source component as it lies in the target's axes, and the target component beside it.
struct ComponentPair {
    Eigen::Vector3d arm;         ///< from the source's centre to the component's mean [m]
    Eigen::Matrix3d covariance;  ///< C of the source component, rotated [m^2]
    Eigen::Vector3d between;     ///< mu: source mean less target mean [m]
    Eigen::Matrix3d widened;     ///< S of the target component [m^2]
    double width_m = 1.0;        ///< that it was widened by
};

/// The cost of one pair, in [-1, 0].
double pairCost(const ComponentPair& pair);

/// Adds one pair; returns its gradient.
Vector6d addPair(const ComponentPair& pair, CostSums& sums);

/// exp(w) of a rotation vector [rad].
Eigen::Matrix3d rotationOf(const Eigen::Vector3d& w);

/// [a]x, the matrix of the cross product a x b.
Eigen::Matrix3d crossMatrix(const Eigen::Vector3d& a);

}  // namespace hgmm
