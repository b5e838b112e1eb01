#include "mixture/knee.h"

#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <limits>

namespace hgmm {

namespace {

/// Smallest of the mixtures nearest to the reference.
std::size_t smallestWithoutLoss(const std::vector<DivergencePoint>& curve) {
    std::size_t best = 0;
    for (std::size_t i = 1; i < curve.size(); ++i)
        if (curve[i].divergence <= curve[best].divergence) best = i;
    return best;
}

/// Two joined lines of divergence over size: y = level + slope x + bend max(x, 0),
/// where x is the number of components taken away since the joint.
struct BrokenLine {
    double bend = 0;          ///< change of slope at the joint [nat per component]
    double squaredError = 0;  ///< sum over the points [nat^2]
};

BrokenLine fitBrokenLine(const DivergencePoint* curve, std::size_t n, std::size_t joint) {
    // The size of the first mixture is the unit, so that the equations are well scaled.
    const auto unit = static_cast<double>(curve[0].size);
    const auto terms = [&](std::size_t i) {
        const double x =
            (static_cast<double>(curve[joint].size) - static_cast<double>(curve[i].size)) /
            unit;
        return Eigen::Vector3d(1, x, x > 0 ? x : 0);
    };
    Eigen::Matrix3d normal = Eigen::Matrix3d::Zero();
    Eigen::Vector3d right = Eigen::Vector3d::Zero();
    for (std::size_t i = 0; i < n; ++i) {
        normal += terms(i) * terms(i).transpose();
        right += terms(i) * curve[i].divergence;
    }
    const Eigen::Vector3d coefficients = normal.ldlt().solve(right);
    BrokenLine fit;
    fit.bend = coefficients[2] / unit;
    for (std::size_t i = 0; i < n; ++i) {
        const double residual = curve[i].divergence - coefficients.dot(terms(i));
        fit.squaredError += residual * residual;
    }
    return fit;
}

}  // namespace

bool isFidelityCandidate(const DivergencePoint& point, const DivergencePoint& reference) {
    return 12 * point.size >= reference.size;
}

std::size_t findKnee(const std::vector<DivergencePoint>& curve) {
    const std::size_t lossless = smallestWithoutLoss(curve);
    std::size_t n = 0;
    while (n < curve.size() && isFidelityCandidate(curve[n], curve[0])) ++n;
    if (n < 4 || lossless + 1 >= n) return lossless;

    double leastError = std::numeric_limits<double>::infinity();
    std::size_t knee = lossless;
    for (std::size_t joint = 1; joint + 1 < n; ++joint) {
        const BrokenLine fit = fitBrokenLine(curve.data(), n, joint);
        if (!(fit.squaredError < leastError)) continue;
        leastError = fit.squaredError;
        // A straight curve, or one that flattens, has no knee.
        knee = fit.bend > 1e-9 ? joint : lossless;
    }
    return knee;
}

}  // namespace hgmm
