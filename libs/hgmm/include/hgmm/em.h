#pragma once
#include <cstddef>
#include <cstdint>
#include <vector>

#include "hgmm/mixture.h"

namespace hgmm {

/// Expectation-Maximization, thesis 3.1.2.
struct EmParams {
    int maxIterations = 5;  ///< E- and M-steps [count], >= 0
    double minImprovement =
        1e-3;  ///< stop when the log-likelihood gains less [nat/point], >= 0

    /// Throws std::invalid_argument naming the field.
    void validate() const;
};

template <int D>
struct EmResult {
    Mixture<D>
        mixture;  ///< supports sum to those of the samples; emptied components are gone
    /// Mean expected log-likelihood before each M-step and after the last [nat/point];
    /// never falls.
    std::vector<double> logLikelihood;
};

/// Which components each sample may belong to: those of sample i are
/// component[begin[i]] .. component[begin[i + 1]], at least one, in rising order.
struct Neighbourhoods {
    std::vector<std::uint32_t> begin;  ///< size = samples + 1
    std::vector<std::uint32_t> component;
};

/// Reference: every component sees every sample, eq. (3.8)-(3.12), in log space.
///
/// A sample with scatter C enters the E-step by its expected log-likelihood,
/// log N(mean | Theta_j) - 1/2 trace(Sigma_j^-1 C) per point, and the M-step with its full
/// second moment, so that fitting leaf moments equals fitting the points behind them where
/// these agree on their component.
template <int D>
EmResult<D> fitDense(const Mixture<D>& samples, const Mixture<D>& initial,
                     const EmParams& params);

/// Engine: a sample sees its neighbourhood only. Cost is linear in the number of samples.
template <int D>
EmResult<D> fitSparse(const Mixture<D>& samples, const Mixture<D>& initial,
                      const Neighbourhoods& neighbourhoods, const EmParams& params);

/// log p(x | mixture), thesis eq. (3.2), of D numbers [nat], over all components; -infinity
/// never leaves: far from all components the result is the finite log-density of the
/// nearest.
template <int D>
double logDensity(const Mixture<D>& mixture, const double* x);

}  // namespace hgmm
