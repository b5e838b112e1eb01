#include "hgmm/em.h"

#include <stdexcept>

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

template EmResult<2> fitSparse(const Mixture<2>&, const Mixture<2>&, const Neighbourhoods&,
                               const EmParams&);
template EmResult<3> fitSparse(const Mixture<3>&, const Mixture<3>&, const Neighbourhoods&,
                               const EmParams&);

}  // namespace hgmm
