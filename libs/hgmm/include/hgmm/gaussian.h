#pragma once
#include <array>
#include <cmath>

#include "hgmm/export.h"
#include "hgmm/mixture.h"

namespace hgmm {

constexpr double kLogTwoPi = 1.8378770664093454836;

/// A Gaussian made ready for evaluation: its mean and the inverse W of its Cholesky factor,
/// so that the squared Mahalanobis distance is |W (x - mean)|^2 and neither an inverse nor
/// a determinant is formed (Sigma = L L^T, W = L^-1, log|Sigma|^(-1/2) = sum log W_kk).
template <int D, typename Scalar = double>
class WhitenedGaussian {
 public:
    WhitenedGaussian() = default;

    /// Factors a covariance. One that is not positive definite (rounding, or degenerate
    /// input) has its pivots raised to `minVariance`, so that the result is always finite.
    /// The library has it for D = 1 to 4, and for D = 3 in floats.
    HGMM_EXPORT explicit WhitenedGaussian(const Gaussian<D>& g, double minVariance = 1e-12);

    /// (x - mu)^T Sigma^-1 (x - mu), >= 0.
    Scalar squaredMahalanobis(const Scalar* x) const {
        Scalar sum = 0;
        for (int row = 0; row < D; ++row) sum += squaredRow(row, x);
        return sum;
    }

    /// squaredMahalanobis(x) <= maxSquared, given up at the first row that exceeds it: most
    /// of an index's candidates are settled by one coordinate.
    bool isWithin(const Scalar* x, Scalar maxSquared) const {
        Scalar sum = 0;
        for (int row = 0; row < D; ++row) {
            sum += squaredRow(row, x);
            if (!(sum <= maxSquared)) return false;
        }
        return true;
    }

    /// log N(x | mu, Sigma) [nat], thesis eq. (3.3).
    Scalar logPdf(const Scalar* x) const {
        return logNormalizer_ - Scalar(0.5) * squaredMahalanobis(x);
    }

    /// trace(Sigma^-1 C) for a symmetric C.
    template <typename Derived>
    Scalar traceOfPrecisionTimes(const Eigen::MatrixBase<Derived>& C) const {
        Scalar trace = 0;
        for (int row = 0; row < D; ++row)
            for (int a = 0; a <= row; ++a)
                for (int b = 0; b <= row; ++b)
                    trace +=
                        factor_[lower(row, a)] * factor_[lower(row, b)] * Scalar(C(a, b));
        return trace;
    }

    /// log of the density at the mean [nat].
    Scalar logNormalizer() const { return logNormalizer_; }
    /// log |Sigma| [nat].
    Scalar logDeterminant() const {
        return Scalar(-2) * logNormalizer_ - Scalar(D * kLogTwoPi);
    }
    Scalar mean(int axis) const { return mean_[axis]; }
    /// Entry of W, row >= col.
    Scalar factor(int row, int col) const { return factor_[lower(row, col)]; }

 private:
    /// Square of row `row` of W (x - mean).
    Scalar squaredRow(int row, const Scalar* x) const {
        Scalar whitened = 0;
        for (int col = 0; col <= row; ++col)
            whitened += factor_[lower(row, col)] * (x[col] - mean_[col]);
        return whitened * whitened;
    }
    static constexpr int lower(int row, int col) { return row * (row + 1) / 2 + col; }

    std::array<Scalar, D> mean_{};
    std::array<Scalar, packedSize(D)> factor_{};
    Scalar logNormalizer_ = 0;
};

/// log(exp(a) + exp(b)) without overflow; -infinity stands for zero.
inline double logAddExp(double a, double b) {
    if (a < b) std::swap(a, b);
    return std::isinf(a) ? a : a + std::log1p(std::exp(b - a));
}

}  // namespace hgmm
