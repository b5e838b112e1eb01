#include "hgmm/em.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "hgmm/gaussian.h"
#include "mixture/em_fit.h"

namespace hgmm {

namespace {

void checkNeighbourhoods(const Neighbourhoods& n, std::size_t samples,
                         std::size_t components) {
    if (n.begin.size() != samples + 1 || n.begin.front() != 0 ||
        n.begin.back() != n.component.size())
        throw std::invalid_argument("Neighbourhoods::begin does not fit the samples");
    for (std::size_t i = 0; i < samples; ++i) {
        if (n.begin[i] >= n.begin[i + 1] || n.begin[i + 1] > n.component.size())
            throw std::invalid_argument(
                "Neighbourhoods::begin leaves a sample without component");
        for (std::uint32_t e = n.begin[i]; e < n.begin[i + 1]; ++e)
            if (n.component[e] >= components ||
                (e > n.begin[i] && n.component[e] <= n.component[e - 1]))
                throw std::invalid_argument(
                    "Neighbourhoods::component is out of range or not rising");
    }
}

}  // namespace

template <int D>
EmResult<D> fitSparse(const Mixture<D>& samples, const Mixture<D>& initial,
                      const Neighbourhoods& neighbourhoods, const EmParams& params) {
    params.validate();
    EmResult<D> result;
    if (samples.empty()) return result;
    if (initial.empty()) throw std::invalid_argument("EM needs an initial mixture");
    checkNeighbourhoods(neighbourhoods, samples.size(), initial.size());

    em::Fit<D> fit(samples, initial, neighbourhoods);
    result.logLikelihood.push_back(fit.expect());
    for (int iteration = 0; iteration < params.maxIterations; ++iteration) {
        fit.maximise();
        const double before = result.logLikelihood.back();
        result.logLikelihood.push_back(fit.expect());
        if (result.logLikelihood.back() - before < params.minImprovement) break;
    }
    result.mixture = fit.mixture();
    return result;
}

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

template EmResult<2> fitDense(const Mixture<2>&, const Mixture<2>&, const EmParams&);
template EmResult<3> fitDense(const Mixture<3>&, const Mixture<3>&, const EmParams&);
template EmResult<4> fitDense(const Mixture<4>&, const Mixture<4>&, const EmParams&);
template EmResult<2> fitSparse(const Mixture<2>&, const Mixture<2>&, const Neighbourhoods&,
                               const EmParams&);
template EmResult<3> fitSparse(const Mixture<3>&, const Mixture<3>&, const Neighbourhoods&,
                               const EmParams&);
template EmResult<4> fitSparse(const Mixture<4>&, const Mixture<4>&, const Neighbourhoods&,
                               const EmParams&);
template double logDensity(const Mixture<2>&, const double*);
template double logDensity(const Mixture<3>&, const double*);
template double logDensity(const Mixture<4>&, const double*);

}  // namespace hgmm
