#pragma once
#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <cstddef>

namespace hgmm::evaluation {

/// Squared exponential kernel k(a, b) = signalStd^2 exp(-(a - b)^2 / (2 lengthScale^2)) and
/// white observation noise; prior mean zero.
struct GpHyperparameters {
    double signalStd = 1.0;    ///< [unit of y], > 0
    double lengthScale = 1.0;  ///< [unit of x], > 0
    double noiseStd = 0.1;     ///< [unit of y], > 0
};

/// Mean and variance of an observation, its noise included.
struct Prediction {
    double mean = 0.0;      ///< [unit of y]
    double variance = 0.0;  ///< [unit of y squared], > 0
};

/// A Gaussian process given all data at one set of hyper-parameters.
class GpPosterior {
 public:
    /// Throws std::invalid_argument if x lies outside the interval.
    Prediction predict(double x) const;
    /// log p(y | x, hyper-parameters) of all data [nat].
    double logMarginalLikelihood() const { return logMarginalLikelihood_; }

 private:
    friend class GpRegression;

    double low_ = 0, high_ = 1;
    double noiseVariance_ = 0;
    Eigen::MatrixXd features_;  ///< R of K_zz = R R^T, nodes x rank
    Eigen::LLT<Eigen::MatrixXd> information_;
    Eigen::VectorXd weights_;  ///< posterior mean of the features' weights
    double logMarginalLikelihood_ = 0;
};

/// Exact Gaussian process regression over an interval, at a cost that does not grow with
/// the number of data.
///
/// The kernel is replaced by its interpolant in both arguments through kNodes Chebyshev
/// points z, k(a, b) = l(a)^T K_zz l(b) with Lagrange polynomials l. It is analytic, so the
/// error falls faster than geometrically: with length scales from minLengthScale() up it is
/// within rounding, and the tests hold it against a dense Cholesky solution. The process is
/// then Bayesian linear regression (Rasmussen and Williams, "Gaussian Processes for Machine
/// Learning", 2006, 2.1), and the sums of l l^T, l y and y^2 are all that it needs to know
/// of the data, for any hyper-parameters.
class GpRegression {
 public:
    static constexpr int kNodes = 48;

    /// Data and queries lie in [low, high]. Throws std::invalid_argument unless low < high,
    /// both finite.
    GpRegression(double low, double high);

    /// Throws std::invalid_argument if x lies outside the interval or y is not finite.
    void add(double x, double y);
    std::size_t size() const { return count_; }

    /// Shortest length scale that the nodes resolve: a twelfth of the interval [unit of x].
    double minLengthScale() const { return (high_ - low_) / 12; }

    /// Throws std::invalid_argument if a hyper-parameter is not in [1e-50, 1e50] or the
    /// length scale is shorter than minLengthScale().
    GpPosterior condition(const GpHyperparameters& hyperparameters) const;

    /// Hyper-parameters of largest marginal likelihood, by coordinate-wise pattern search
    /// on their logarithms from `start`, to 0.1 %. Deterministic; finds a local maximum.
    /// Throws std::invalid_argument as condition() does, for `start`.
    GpHyperparameters maximiseLikelihood(const GpHyperparameters& start) const;

 private:
    double low_, high_;
    std::size_t count_ = 0;
    Eigen::MatrixXd sumOuter_;  ///< sum of l(x) l(x)^T
    Eigen::VectorXd sumTimes_;  ///< sum of l(x) y
    double sumSquares_ = 0;     ///< sum of y^2
};

}  // namespace hgmm::evaluation
