#include "maps/gp_octomap_gp.h"

#include <cmath>

namespace hgmm::evaluation::gp_octomap {
namespace {

/// Covariances of the points `a` (rows) and `b` (columns).
Eigen::MatrixXd covariance(const PointMatrix& a, const PointMatrix& b, const Kernel& k) {
    Eigen::ArrayXXd s(a.cols(), b.cols());
    for (Eigen::Index j = 0; j < b.cols(); ++j)
        s.col(j) = (a.colwise() - b.col(j)).colwise().squaredNorm().transpose();
    s = (std::sqrt(3.0) / k.length_m) * s.sqrt();
    return k.sigmaF * k.sigmaF * (1.0 + s) * (-s).exp();
}

}  // namespace

LocalGp::LocalGp(PointMatrix points_m, const Eigen::VectorXd& labels, const Kernel& kernel)
    : kernel_(kernel), points_(std::move(points_m)) {
    Eigen::MatrixXd K = covariance(points_, points_, kernel_);
    K.diagonal().array() += kernel_.noise * kernel_.noise;
    llt_.compute(K);
    weights_ = llt_.solve(labels);
}

void LocalGp::predict(const PointMatrix& points_m, Predictions& out) const {
    Eigen::MatrixXd cross = covariance(points_, points_m, kernel_);
    out.mean.noalias() = cross.transpose() * weights_;
    llt_.matrixL().solveInPlace(cross);
    const double prior = kernel_.sigmaF * kernel_.sigmaF;
    out.variance =
        (prior - cross.colwise().squaredNorm().array()).max(0.0).min(prior).transpose();
}

}  // namespace hgmm::evaluation::gp_octomap
