#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <vector>

#include "hgmm/divergence.h"
#include "hgmm/em.h"
#include "hgmm/sampling.h"

namespace hgmm {

namespace {

using Points = std::array<std::vector<float>, 3>;

/// Log-density of a mixture at each point [nat].
std::vector<double> logDensities(const Points& points, const Mixture<3>& mixture) {
    constexpr double reach = 6;  // [sigma]
    const Neighbourhoods near = neighbourhoodsOf(points, mixture, reach);
    const double total = mixture.totalSupport();
    std::vector<WhitenedGaussian<3>> factors;
    std::vector<double> logWeights;
    for (std::size_t j = 0; j < mixture.size(); ++j) {
        factors.emplace_back(mixture[j]);
        logWeights.push_back(std::log(mixture.weight(j, total)));
    }
    std::vector<double> result(points[0].size());
    for (std::size_t i = 0; i < result.size(); ++i) {
        const double x[3] = {points[0][i], points[1][i], points[2][i]};
        double sum = -std::numeric_limits<double>::infinity();
        for (std::uint32_t k = near.begin[i]; k < near.begin[i + 1]; ++k) {
            const std::uint32_t j = near.component[k];
            sum = logAddExp(sum, logWeights[j] + factors[j].logPdf(x));
        }
        result[i] = sum;
    }
    return result;
}

}  // namespace

SampledDivergence sampledKlDivergence(const Mixture<3>& p, const Mixture<3>& q,
                                      std::size_t n, std::uint64_t seed) {
    if (p.empty() || q.empty())
        throw std::invalid_argument("divergence of an empty mixture");
    if (n < 2) throw std::invalid_argument("sampledKlDivergence: needs two points or more");
    const std::vector<float> drawn = samplePoints(p, n, seed);
    Points points;
    for (std::size_t i = 0; i < drawn.size(); ++i) points[i % 3].push_back(drawn[i]);
    const std::vector<double> logP = logDensities(points, p),
                              logQ = logDensities(points, q);
    double mean = 0, squares = 0;
    for (std::size_t i = 0; i < n; ++i) {
        const double difference = logP[i] - logQ[i], before = mean;
        mean += (difference - mean) / static_cast<double>(i + 1);
        squares += (difference - before) * (difference - mean);
    }
    const auto count = static_cast<double>(n);
    return {std::max(0.0, mean), std::sqrt(squares / (count - 1) / count)};
}

}  // namespace hgmm
