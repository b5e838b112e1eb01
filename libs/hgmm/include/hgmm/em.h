#pragma once
#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <stdexcept>
#include <vector>

#include "hgmm/export.h"
#include "hgmm/gaussian.h"
#include "hgmm/mixture.h"
#include "hgmm/params.h"

namespace hgmm {

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

/// The fast one: a sample sees its neighbourhood only. Cost is linear in the number of
/// samples. The library has it for D = 2 and 3.
template <int D>
HGMM_EXPORT EmResult<D> fitSparse(const Mixture<D>& samples, const Mixture<D>& initial,
                                  const Neighbourhoods& neighbourhoods,
                                  const EmParams& params);

/// Reference: every component sees every sample, eq. (3.8)-(3.12), in log space.
///
/// A sample with scatter C enters the E-step by its expected log-likelihood,
/// log N(mean | Theta_j) - 1/2 trace(Sigma_j^-1 C) per point, and the M-step with its full
/// second moment, so that fitting leaf moments equals fitting the points behind them where
/// these agree on their component.
template <int D>
EmResult<D> fitDense(const Mixture<D>& samples, const Mixture<D>& initial,
                     const EmParams& params) {
    if (!initial.empty() &&
        samples.size() > std::numeric_limits<std::uint32_t>::max() / initial.size())
        throw std::invalid_argument("fitDense: samples times components exceed 2^32");
    Neighbourhoods everything;
    everything.begin.resize(samples.size() + 1);
    everything.component.resize(samples.size() * initial.size());
    for (std::size_t i = 0, e = 0; i < samples.size(); ++i) {
        everything.begin[i] = static_cast<std::uint32_t>(e);
        for (std::size_t j = 0; j < initial.size(); ++j)
            everything.component[e++] = static_cast<std::uint32_t>(j);
    }
    everything.begin.back() = static_cast<std::uint32_t>(everything.component.size());
    return fitSparse(samples, initial, everything, params);
}

/// log p(x | mixture), thesis eq. (3.2), of D numbers [nat], over all components; -infinity
/// never leaves: far from all components the result is the finite log-density of the
/// nearest.
template <int D>
double logDensity(const Mixture<D>& mixture, const double* x) {
    if (mixture.empty()) throw std::invalid_argument("logDensity of an empty mixture");
    const double total = mixture.totalSupport();
    std::vector<double> terms(mixture.size());
    for (std::size_t j = 0; j < mixture.size(); ++j)
        terms[j] =
            std::log(mixture.weight(j, total)) + WhitenedGaussian<D>(mixture[j]).logPdf(x);
    const double largest = *std::max_element(terms.begin(), terms.end());
    double sum = 0;
    for (const double term : terms) sum += std::exp(term - largest);
    return largest + std::log(sum);
}

/// The components within `sigmas` of each point, or the likeliest one where there are none:
/// neighbourhoods for fitSparse without a first guess by cells. Throws
/// std::invalid_argument for an empty mixture.
/// @param points the coordinates of point i are at [d][i]
HGMM_EXPORT Neighbourhoods neighbourhoodsOf(const std::array<std::vector<float>, 3>& points,
                                            const Mixture<3>& mixture, double sigmas);

/// A first guess ready for fitSparse.
struct InitialMixture {
    Mixture<3> mixture;             ///< one component per cell, or part of a cell
    Neighbourhoods neighbourhoods;  ///< a sample's component and those near it
};

/// An overestimate of the fidelity threshold: the moments of the samples in each cell
/// (thesis 3.3.4). Cells follow each sample's own range |sample - sensorOrigin| in octaves.
/// Samples and origin are in the same frame.
HGMM_EXPORT InitialMixture initialiseFromCells(const Mixture<3>& samples,
                                               const Eigen::Vector3d& sensorOrigin,
                                               const CellParams& params);

}  // namespace hgmm
