#include "hgmm/evaluation/gp_regression.h"

#include <Eigen/Eigenvalues>
#include <array>
#include <cmath>
#include <stdexcept>
#include <string>

namespace hgmm::evaluation {
namespace {

constexpr double kPi = 3.14159265358979323846;
constexpr double kLogTwoPi = 1.8378770664093454836;
/// Eigenvalues of the kernel at the nodes below this share of their sum are rounding.
constexpr double kRounding = 1e-15;
/// The search for hyper-parameters halves its step from one to the other [nat].
constexpr double kFirstStep = 0.5, kLastStep = 1e-3;

/// Chebyshev points of the second kind in [low, high].
double node(int k, double low, double high) {
    return 0.5 * (low + high) +
           0.5 * (high - low) * std::cos(kPi * k / (GpRegression::kNodes - 1));
}

/// Lagrange polynomials of the nodes at x, by the second barycentric formula (Berrut and
/// Trefethen, SIAM Review 46, 2004).
Eigen::VectorXd lagrange(double x, double low, double high) {
    constexpr int n = GpRegression::kNodes;
    if (!(x >= low && x <= high))
        throw std::invalid_argument("GpRegression: " + std::to_string(x) +
                                    " lies outside the interval");
    Eigen::VectorXd l(n);
    for (int k = 0; k < n; ++k) {
        const double distance = x - node(k, low, high);
        if (distance == 0) return Eigen::VectorXd::Unit(n, k);
        const double end = k == 0 || k == n - 1 ? 0.5 : 1.0;
        l[k] = (k % 2 == 0 ? end : -end) / distance;
    }
    return l / l.sum();
}

/// R with K_zz = R R^T, without the directions that are lost in rounding.
Eigen::MatrixXd kernelRoot(const GpHyperparameters& h, double low, double high) {
    constexpr int n = GpRegression::kNodes;
    Eigen::MatrixXd K(n, n);
    for (int i = 0; i < n; ++i)
        for (int j = 0; j < n; ++j) {
            const double d = (node(i, low, high) - node(j, low, high)) / h.lengthScale;
            K(i, j) = h.signalStd * h.signalStd * std::exp(-0.5 * d * d);
        }
    const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(K);
    const Eigen::VectorXd& values = eigen.eigenvalues();  // rising
    int first = 0;
    while (values[first] <= kRounding * values.sum()) ++first;
    const int rank = n - first;
    return eigen.eigenvectors().rightCols(rank) *
           values.tail(rank).cwiseSqrt().asDiagonal();
}

std::array<double, 3> logarithms(const GpHyperparameters& h) {
    return {std::log(h.signalStd), std::log(h.lengthScale), std::log(h.noiseStd)};
}

GpHyperparameters fromLogarithms(const std::array<double, 3>& logs) {
    return {std::exp(logs[0]), std::exp(logs[1]), std::exp(logs[2])};
}

/// Within reach of the squares and quotients that are formed of it.
bool isUsable(double v) {
    return v >= 1e-50 && v <= 1e50;
}

}  // namespace

GpRegression::GpRegression(double low, double high)
    : low_(low),
      high_(high),
      sumOuter_(Eigen::MatrixXd::Zero(kNodes, kNodes)),
      sumTimes_(Eigen::VectorXd::Zero(kNodes)) {
    if (!(low < high) || !std::isfinite(high - low))
        throw std::invalid_argument("GpRegression: the interval is empty or not finite");
}

void GpRegression::add(double x, double y) {
    if (!std::isfinite(y))
        throw std::invalid_argument("GpRegression: an observation is not finite");
    const Eigen::VectorXd l = lagrange(x, low_, high_);
    sumOuter_.noalias() += l * l.transpose();
    sumTimes_ += y * l;
    sumSquares_ += y * y;
    ++count_;
}

GpPosterior GpRegression::condition(const GpHyperparameters& h) const {
    if (!isUsable(h.signalStd) || !isUsable(h.lengthScale) || !isUsable(h.noiseStd))
        throw std::invalid_argument("GpHyperparameters must all be in [1e-50, 1e50]");
    if (h.lengthScale < minLengthScale())
        throw std::invalid_argument(
            "GpHyperparameters::lengthScale is shorter than a twelfth of the interval");
    GpPosterior p;
    p.low_ = low_;
    p.high_ = high_;
    p.noiseVariance_ = h.noiseStd * h.noiseStd;
    p.features_ = kernelRoot(h, low_, high_);
    const Eigen::MatrixXd& R = p.features_;
    const auto rank = R.cols();
    p.information_.compute(Eigen::MatrixXd::Identity(rank, rank) +
                           R.transpose() * sumOuter_ * R / p.noiseVariance_);
    const Eigen::VectorXd projected = R.transpose() * sumTimes_ / p.noiseVariance_;
    p.weights_ = p.information_.solve(projected);

    const Eigen::MatrixXd L = p.information_.matrixL();
    const double logDeterminant = 2 * L.diagonal().array().log().sum();
    const double misfit = sumSquares_ / p.noiseVariance_ - projected.dot(p.weights_);
    p.logMarginalLikelihood_ =
        -0.5 * (static_cast<double>(count_) * (kLogTwoPi + std::log(p.noiseVariance_)) +
                logDeterminant + misfit);
    return p;
}

Prediction GpPosterior::predict(double x) const {
    const Eigen::VectorXd f = features_.transpose() * lagrange(x, low_, high_);
    const double latent = information_.matrixL().solve(f).squaredNorm();
    return {f.dot(weights_), latent + noiseVariance_};
}

GpHyperparameters GpRegression::maximiseLikelihood(const GpHyperparameters& start) const {
    std::array<double, 3> best = logarithms(start);
    double bestLikelihood = condition(start).logMarginalLikelihood();
    for (double step = kFirstStep; step > kLastStep;) {
        bool improved = false;
        for (std::size_t axis = 0; axis < best.size(); ++axis)
            for (const double move : {step, -step}) {
                std::array<double, 3> trial = best;
                trial[axis] += move;
                const GpHyperparameters h = fromLogarithms(trial);
                if (h.lengthScale < minLengthScale()) continue;
                const double likelihood = condition(h).logMarginalLikelihood();
                if (!(likelihood > bestLikelihood)) continue;
                bestLikelihood = likelihood;
                best = trial;
                improved = true;
                break;
            }
        if (!improved) step /= 2;
    }
    return fromLogarithms(best);
}

}  // namespace hgmm::evaluation
