#pragma once
#include <algorithm>
#include <cstdint>
#include <random>

#include "hgmm/em.h"
#include "planted_mixture.h"

namespace hgmm::test {

/// Overlapping components in [-1, 1]^D, the last axis being W.
template <int D>
Mixture<D> randomMixture(std::size_t components, std::uint64_t seed) {
    std::mt19937_64 engine(seed);
    Mixture<D> mixture;
    for (std::size_t j = 0; j < components; ++j) {
        Gaussian<D> g;
        g.support = uniform(engine, 1, 50);
        for (int a = 0; a < D; ++a) g.mean[a] = uniform(engine, -1, 1);
        g.covariance = randomCovariance<D>(engine, 8);
        mixture.pushBack(g);
    }
    return mixture;
}

/// log p(x, w): the joint density by the code that EM uses.
template <int D>
double logJoint(const Mixture<D>& mixture, const double* x, double w) {
    double point[D];
    std::copy(x, x + D - 1, point);
    point[D - 1] = w;
    return logDensity(mixture, point);
}

}  // namespace hgmm::test
