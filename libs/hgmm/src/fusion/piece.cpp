#include "fusion/piece.h"

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <cmath>

namespace hgmm {

namespace {

constexpr double kWidthPerThickness = 7.0;
/// Range noise and shallow steps, as of a door in its frame, make narrow pieces thick: less
/// thick ones need be four times wider only [m].
constexpr double kNoise_m = 0.04, kWidthPerNoise = 4.0;
constexpr double kBehindSigmas = 3.0;
/// What poses are off by at 1 m, growing with the root of the range [m], and of the range
/// [1].
constexpr double kErrorAtOneMetre_m = 0.02, kErrorPerMetre = 0.015;

}  // namespace

Piece pieceOf(const Gaussian<3>& component, const Eigen::Vector3d& normalOfRays) {
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> eigen(
        Eigen::Matrix3d(component.covariance));
    const Eigen::Vector3d sigma = eigen.eigenvalues().cwiseMax(0.0).cwiseSqrt();
    if (normalOfRays.isZero()) return {eigen.eigenvectors().col(0), sigma[0], sigma[1]};
    const Eigen::Vector3d across =
        normalOfRays.cross(eigen.eigenvectors().col(2)).normalized();
    const Eigen::Matrix3d covariance = component.covariance;
    return {across, std::sqrt(across.dot(covariance * across)), sigma[2]};
}

bool isSheet(const Piece& piece) {
    const double most = piece.thickness_m < kNoise_m ? kWidthPerNoise : kWidthPerThickness;
    return piece.thickness_m * most <= piece.width_m;
}

double clearBehind(double sigma_m, double range_m) {
    return kBehindSigmas * sigma_m + kErrorAtOneMetre_m * std::sqrt(range_m) +
           kErrorPerMetre * range_m;
}

}  // namespace hgmm
