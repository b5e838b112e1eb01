#include "hgmm/regression.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "base/normal_mass.h"
#include "mixture/regularized.h"

namespace hgmm {

namespace {

constexpr double kNever = -std::numeric_limits<double>::infinity();
constexpr double kSmallestWeight = 1e-12;
constexpr double kSmallestVariance = 1e-12;

double logNormal(double value, double mean, double variance) {
    const double d = value - mean;
    return -0.5 * (kLogTwoPi + std::log(variance) + d * d / variance);
}

/// log(sum exp(logs)), with the largest taken out.
double logSumExp(const std::vector<double>& logs) {
    const double largest = *std::max_element(logs.begin(), logs.end());
    double sum = 0;
    for (const double v : logs) sum += std::exp(v - largest);
    return largest + std::log(sum);
}

/// The leading part of a component: its marginal over X.
template <int D>
Gaussian<D - 1> marginal(const Gaussian<D>& joint) {
    Gaussian<D - 1> g;
    g.support = joint.support;
    g.mean = joint.mean.template head<D - 1>();
    g.covariance = joint.covariance.template topLeftCorner<D - 1, D - 1>();
    return g;
}

/// A component given W = 0: thesis eq. (4.11) and (4.12).
template <int D>
Gaussian<D - 1> atZero(const Gaussian<D>& joint, double varianceW) {
    const Eigen::Matrix<double, D - 1, 1> cross =
        joint.covariance.template topRightCorner<D - 1, 1>();
    Gaussian<D - 1> g = marginal<D>(joint);
    g.mean += cross * ((0 - joint.mean[D - 1]) / varianceW);
    g.covariance -= cross * cross.transpose() / varianceW;
    return g;
}

}  // namespace

template <int D>
RegressedGaussian<D>::RegressedGaussian(const Gaussian<D>& joint, double weight)
    : place_(marginal<D>(joint)), meanW_(joint.mean[D - 1]), logWeight_(std::log(weight)) {
    // With W last, the last row of the inverse Cholesky factor is (-slope^T, 1) / sigma.
    const WhitenedGaussian<D> whitened(joint);
    const double inverseSigma = whitened.factor(D - 1, D - 1);
    variance_ = 1 / (inverseSigma * inverseSigma);
    for (int a = 0; a < D - 1; ++a) slope_[a] = -whitened.factor(D - 1, a) / inverseSigma;
}

double Conditional::logDensity(double w) const {
    double sum = kNever;
    for (const Term& t : terms_)
        if (t.weight > 0)
            sum = logAddExp(sum, std::log(t.weight) + logNormal(w, t.mean, t.variance));
    return sum;
}

double Conditional::mean() const {
    double sum = 0;
    for (const Term& t : terms_) sum += t.weight * t.mean;
    return sum;
}

double Conditional::variance() const {
    const double center = mean();
    double sum = 0;
    for (const Term& t : terms_) {
        const double d = t.mean - center;
        sum += t.weight * (t.variance + d * d);
    }
    return sum;
}

double Conditional::mass(double low, double high) const {
    if (!(low <= high))
        throw std::invalid_argument("Conditional::mass: low must not exceed high");
    double sum = 0;
    for (const Term& t : terms_) {
        const double sigma = std::sqrt(t.variance);
        sum += t.weight * normalMass((low - t.mean) / sigma, (high - t.mean) / sigma);
    }
    return std::min(sum, 1.0);  // rounding
}

template <int D>
Mixture<D - 1> spatialModel(const Mixture<D>& joint) {
    Mixture<D - 1> out;
    if (joint.empty()) return out;
    const double total = joint.totalSupport();
    std::vector<double> variances(joint.size()), logWeights(joint.size());
    for (std::size_t j = 0; j < joint.size(); ++j) {
        const Gaussian<D> g = joint[j];
        variances[j] = std::max(g.covariance(D - 1, D - 1), kSmallestVariance);
        logWeights[j] =
            std::log(joint.weight(j, total)) + logNormal(0, g.mean[D - 1], variances[j]);
    }
    const double logSum = logSumExp(logWeights);
    for (std::size_t j = 0; j < joint.size(); ++j) {
        const double weight = std::exp(logWeights[j] - logSum);  // thesis eq. (4.13)
        if (weight < kSmallestWeight) continue;
        Gaussian<D - 1> slice = regularized(atZero<D>(joint[j], variances[j]));
        slice.support = weight * total;
        out.pushBack(slice);
    }
    return out;
}

template class RegressedGaussian<2>;
template class RegressedGaussian<4>;
template Mixture<3> spatialModel(const Mixture<4>&);

}  // namespace hgmm
