#include "hgmm/divergence.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "mixture/goldberger.h"

namespace hgmm {

namespace {

/// log of the inner product of two mixtures, sum_mk pi_m tau_k N(mu_m | nu_k, S_m + S_k).
template <int D>
double logInnerProduct(const Mixture<D>& p, const Mixture<D>& q) {
    const double totalP = p.totalSupport(), totalQ = q.totalSupport();
    double sum = -std::numeric_limits<double>::infinity();
    for (std::size_t m = 0; m < p.size(); ++m) {
        const Gaussian<D> a = p[m];
        for (std::size_t k = 0; k < q.size(); ++k) {
            Gaussian<D> both = q[k];
            both.covariance += a.covariance;
            const double logWeight = std::log(p.weight(m, totalP) * q.weight(k, totalQ));
            sum =
                logAddExp(sum, logWeight + WhitenedGaussian<D>(both).logPdf(a.mean.data()));
        }
    }
    return sum;
}

template <int D>
void requireComponents(const Mixture<D>& p, const Mixture<D>& q) {
    if (p.empty() || q.empty())
        throw std::invalid_argument("divergence of an empty mixture");
}

}  // namespace

template <int D>
double klDivergence(const WhitenedGaussian<D>& f,
                    const typename Gaussian<D>::Matrix& fCovariance,
                    const WhitenedGaussian<D>& g) {
    std::array<double, D> mean;
    for (int a = 0; a < D; ++a) mean[a] = f.mean(a);
    // thesis eq. (3.14)
    const double divergence = 0.5 * (g.logDeterminant() - f.logDeterminant() +
                                     g.traceOfPrecisionTimes(fCovariance) +
                                     g.squaredMahalanobis(mean.data()) - D);
    return std::max(0.0, divergence);  // rounding
}

template <int D>
double klDivergence(const Mixture<D>& p, const Mixture<D>& q) {
    requireComponents(p, q);
    const GoldbergerSearch<D> search(q);  // for the minimum of thesis eq. (3.15)
    const double total = p.totalSupport();
    double sum = 0;
    for (std::size_t i = 0; i < p.size(); ++i) {
        const double weight = p.weight(i, total);
        GoldbergerMatch best;
        search.improve(PreparedGaussian<D>(p[i]), std::log(weight), best);
        sum += weight * best.cost;
    }
    return sum;
}

template <int D>
double cauchySchwarzDivergence(const Mixture<D>& p, const Mixture<D>& q) {
    requireComponents(p, q);
    const double divergence =
        -logInnerProduct(p, q) + 0.5 * (logInnerProduct(p, p) + logInnerProduct(q, q));
    return std::max(0.0, divergence);  // rounding
}

template double klDivergence(const WhitenedGaussian<2>&, const Gaussian<2>::Matrix&,
                             const WhitenedGaussian<2>&);
template double klDivergence(const WhitenedGaussian<3>&, const Gaussian<3>::Matrix&,
                             const WhitenedGaussian<3>&);
template double klDivergence(const WhitenedGaussian<4>&, const Gaussian<4>::Matrix&,
                             const WhitenedGaussian<4>&);
template double klDivergence(const Mixture<3>&, const Mixture<3>&);
template double cauchySchwarzDivergence(const Mixture<3>&, const Mixture<3>&);

}  // namespace hgmm
