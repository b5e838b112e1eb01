#pragma once
#include <cstddef>
#include <cstdint>

#include "hgmm/export.h"
#include "hgmm/gaussian.h"
#include "hgmm/mixture.h"

namespace hgmm {

/// KL(f || g) between two Gaussians, both factored beforehand [nat], >= 0: thesis eq.
/// (3.14). The library has it for D = 2, 3 and 4.
/// @param fCovariance f's covariance
template <int D>
HGMM_EXPORT double klDivergence(const WhitenedGaussian<D>& f,
                                const typename Gaussian<D>::Matrix& fCovariance,
                                const WhitenedGaussian<D>& g);

/// The same of Gaussians that are not.
template <int D>
double klDivergence(const Gaussian<D>& f, const Gaussian<D>& g) {
    return klDivergence(WhitenedGaussian<D>(f), f.covariance, WhitenedGaussian<D>(g));
}

/// Goldberger's approximation of KL(p || q) between mixtures [nat]: thesis eq. (3.15),
/// after Goldberger, Gordon and Greenspan, ICCV 2003. It is not exact (components that
/// overlap are told apart), and below zero where q's fewer components carry more weight
/// than those of p that they stand for; sampledKlDivergence never is. Throws
/// std::invalid_argument if one is empty. The library has it for D = 3.
template <int D>
HGMM_EXPORT double klDivergence(const Mixture<D>& p, const Mixture<D>& q);

/// KL(p || q) between mixtures [nat], >= 0, as estimated from points drawn from p.
struct SampledDivergence {
    double value = 0;  ///< [nat]; 0 where chance puts the mean below
    double error = 0;  ///< standard deviation of the mean [nat]
};

/// Estimates KL(p || q), thesis eq. (3.13), by the mean of log p(x) - log q(x) over n
/// points drawn from p. Its error falls as 1/sqrt(n).
/// The same seed gives the same estimate. A component counts at a point within 6 sigma of
/// it, or if it is the likeliest there. Throws std::invalid_argument if a mixture is empty
/// or n < 2.
HGMM_EXPORT SampledDivergence sampledKlDivergence(const Mixture<3>& p, const Mixture<3>& q,
                                                  std::size_t n, std::uint64_t seed);

/// Cauchy-Schwarz divergence between mixtures [nat], >= 0, symmetric, in closed form. This
/// is the derivation of thesis eq. (3.18), whose printed form is garbled:
///   -log <p,q> + 1/2 log <p,p> + 1/2 log <q,q>,  <p,q> = sum_mk pi_m tau_k N(mu_m | nu_k,
///   S_m + S_k)
/// It is half of eq. (3.17). Throws std::invalid_argument if one is empty. The library has
/// it for D = 3.
template <int D>
HGMM_EXPORT double cauchySchwarzDivergence(const Mixture<D>& p, const Mixture<D>& q);

}  // namespace hgmm
