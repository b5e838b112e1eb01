#pragma once
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
/// than those of p that they stand for. Throws std::invalid_argument if one is empty. The
/// library has it for D = 3.
template <int D>
HGMM_EXPORT double klDivergence(const Mixture<D>& p, const Mixture<D>& q);

/// Cauchy-Schwarz divergence between mixtures [nat], >= 0, symmetric, in closed form. This
/// is the derivation of thesis eq. (3.18), whose printed form is garbled:
///   -log <p,q> + 1/2 log <p,p> + 1/2 log <q,q>,  <p,q> = sum_mk pi_m tau_k N(mu_m | nu_k,
///   S_m + S_k)
/// It is half of eq. (3.17). Throws std::invalid_argument if one is empty. The library has
/// it for D = 3.
template <int D>
HGMM_EXPORT double cauchySchwarzDivergence(const Mixture<D>& p, const Mixture<D>& q);

}  // namespace hgmm
