#include "registration/registration_cost.h"

#include <Eigen/Cholesky>
#include <Eigen/Geometry>
#include <cmath>

namespace hgmm {

CostSums& CostSums::operator+=(const CostSums& o) {
    cost += o.cost;
    gradient += o.gradient;
    hessian += o.hessian;
    gaussNewton += o.gaussNewton;
    observability += o.observability;
    return *this;
}

double pairCost(const ComponentPair& pair) {
    const Eigen::LLT<Eigen::Matrix3d> B(pair.covariance + pair.widened);
    return -std::exp(-0.5 * B.matrixL().solve(pair.between).squaredNorm());
}

// With u = B^-1 mu and y = arm - C u, h = 1/2 mu^T u has the gradient (y x u, u). Its
// Hessian is G^T B^-1 G, G = (-[y]x - C [u]x, I), plus second derivatives of the rotation:
// of mu, and of C = R S_i R^T, which turns with the source.
Vector6d addPair(const ComponentPair& pair, CostSums& sums) {
    const Eigen::Matrix3d& C = pair.covariance;
    const Eigen::LLT<Eigen::Matrix3d> B(C + pair.widened);
    const Eigen::Vector3d u = B.solve(pair.between);
    const double peak = std::exp(-0.5 * pair.between.dot(u));
    const Eigen::Vector3d y = pair.arm - C * u;
    const Eigen::Matrix3d ux = crossMatrix(u), Cux = C * ux;

    Vector6d slope;
    slope << y.cross(u), u;
    Eigen::Matrix<double, 3, 6> G;
    G << -crossMatrix(y) - Cux, Eigen::Matrix3d::Identity();
    B.matrixL().solveInPlace(G);
    const Matrix6d gaussNewton = peak * (G.transpose() * G);
    const Vector6d gradient = peak * slope;

    sums.cost -= peak;
    sums.gradient += gradient;
    sums.gaussNewton += gaussNewton;
    sums.observability += pair.width_m * pair.width_m * gaussNewton;
    sums.hessian += gaussNewton - gradient * slope.transpose();
    sums.hessian.topLeftCorner<3, 3>() +=
        peak * (0.5 * (y * u.transpose() + u * y.transpose()) -
                u.dot(y) * Eigen::Matrix3d::Identity() - ux.transpose() * Cux);
    return gradient;
}

Eigen::Matrix3d rotationOf(const Eigen::Vector3d& w) {
    const double angle_rad = w.norm();
    if (angle_rad < 1e-12) return Eigen::Matrix3d::Identity() + crossMatrix(w);
    return Eigen::AngleAxisd(angle_rad, w / angle_rad).toRotationMatrix();
}

Eigen::Matrix3d crossMatrix(const Eigen::Vector3d& a) {
    Eigen::Matrix3d m;
    m << 0, -a.z(), a.y(), a.z(), 0, -a.x(), -a.y(), a.x(), 0;
    return m;
}

}  // namespace hgmm
