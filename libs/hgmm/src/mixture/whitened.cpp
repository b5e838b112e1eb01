#include <cmath>

#include "base/portable_math.h"
#include "hgmm/gaussian.h"

namespace hgmm {

template <int D, typename Scalar>
WhitenedGaussian<D, Scalar>::WhitenedGaussian(const Gaussian<D>& g, double minVariance) {
    double L[D][D] = {};
    double logDet = 0;
    for (int i = 0; i < D; ++i) {
        for (int j = 0; j <= i; ++j) {
            double s = g.covariance(i, j);
            for (int k = 0; k < j; ++k) s -= L[i][k] * L[j][k];
            if (i == j) {
                L[i][i] = std::sqrt(s > minVariance ? s : minVariance);
                logDet += 2.0 * portable::log(L[i][i]);
            } else {
                L[i][j] = s / L[j][j];
            }
        }
    }
    for (int col = 0; col < D; ++col) {
        double column[D] = {};
        for (int row = col; row < D; ++row) {
            double s = row == col ? 1.0 : 0.0;
            for (int k = col; k < row; ++k) s -= L[row][k] * column[k];
            column[row] = s / L[row][row];
            factor_[lower(row, col)] = static_cast<Scalar>(column[row]);
        }
    }
    for (int i = 0; i < D; ++i) mean_[i] = static_cast<Scalar>(g.mean[i]);
    logNormalizer_ = static_cast<Scalar>(-0.5 * (D * kLogTwoPi + logDet));
}

template WhitenedGaussian<1>::WhitenedGaussian(const Gaussian<1>&, double);
template WhitenedGaussian<2>::WhitenedGaussian(const Gaussian<2>&, double);
template WhitenedGaussian<3>::WhitenedGaussian(const Gaussian<3>&, double);
template WhitenedGaussian<4>::WhitenedGaussian(const Gaussian<4>&, double);
template WhitenedGaussian<3, float>::WhitenedGaussian(const Gaussian<3>&, double);

}  // namespace hgmm
