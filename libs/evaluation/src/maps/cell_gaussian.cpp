#include "hgmm/evaluation/cell_gaussian.h"

#include <Eigen/Eigenvalues>
#include <algorithm>

namespace hgmm::evaluation {

void PointSums::add(const Eigen::Vector3d& offset_m) {
    n += 1.0;
    first += offset_m;
    second += offset_m * offset_m.transpose();
}

void PointSums::add(const PointSums& other) {
    n += other.n;
    first += other.first;
    second += other.second;
}

void PointSums::limit(double nMax) {
    if (n <= nMax) return;
    const double scale = nMax / n;
    n = nMax;
    first *= scale;
    second *= scale;
}

Eigen::Matrix3d PointSums::covariance() const {
    return (second - first * first.transpose() / n) / (n - 1.0);
}

std::optional<CellGaussian> gaussianOf(const PointSums& sums,
                                       const Eigen::Vector3d& centre_map, double edge_m) {
    if (sums.n < kMinCellPoints) return std::nullopt;
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(sums.covariance());
    const double spot_m = 1e-3 * edge_m;
    const double floor =
        std::max(solver.eigenvalues()[2] / kMaxEigenvalueRatio, spot_m * spot_m);
    const Eigen::Array3d values = solver.eigenvalues().array().max(floor);
    const Eigen::Matrix3d& axes = solver.eigenvectors();

    CellGaussian gaussian;
    gaussian.mean_map = centre_map + sums.mean();
    gaussian.information = axes * values.inverse().matrix().asDiagonal() * axes.transpose();
    gaussian.logDensityAtMean = -0.5 * (3.0 * std::log(2.0 * M_PI) + values.log().sum());
    return gaussian;
}

}  // namespace hgmm::evaluation
