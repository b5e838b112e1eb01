#include "hgmm/sampling.h"

#include <algorithm>
#include <cmath>
#include <random>
#include <stdexcept>

namespace hgmm {

namespace {

/// Uniform in (0, 1], with the 53 bits of a double.
double uniform(std::mt19937_64& engine) {
    return (static_cast<double>(engine() >> 11) + 1.0) * 0x1p-53;
}

/// Standard normal by Box and Muller: unlike std::normal_distribution, the same numbers
/// with every standard library.
double standardNormal(std::mt19937_64& engine) {
    constexpr double kTwoPi = 6.283185307179586477;
    const double radius = std::sqrt(-2.0 * std::log(uniform(engine)));
    return radius * std::cos(kTwoPi * uniform(engine));
}

template <int D>
struct Source {
    typename Gaussian<D>::Vector mean;
    typename Gaussian<D>::Matrix root;  ///< root root^T = covariance, lower triangular
};

/// Cholesky factor; a direction without extent, where the pivot vanishes, stays without.
template <int D>
Source<D> makeSource(const Gaussian<D>& component) {
    Source<D> source{component.mean, Gaussian<D>::Matrix::Zero()};
    auto& L = source.root;
    for (int row = 0; row < D; ++row)
        for (int col = 0; col <= row; ++col) {
            double s = component.covariance(row, col);
            for (int k = 0; k < col; ++k) s -= L(row, k) * L(col, k);
            if (row == col)
                L(row, row) = std::sqrt(std::max(s, 0.0));
            else
                L(row, col) = L(col, col) > 0 ? s / L(col, col) : 0.0;
        }
    return source;
}

}  // namespace

template <int D>
std::vector<float> samplePoints(const Mixture<D>& mixture, std::size_t n,
                                std::uint64_t seed) {
    std::vector<float> points;
    if (n == 0) return points;
    if (mixture.empty()) throw std::invalid_argument("samplePoints: the mixture is empty");

    std::vector<double> cumulative(mixture.size());
    std::vector<Source<D>> sources;
    sources.reserve(mixture.size());
    double total = 0;
    for (std::size_t j = 0; j < mixture.size(); ++j) {
        cumulative[j] = total += mixture.support[j];
        sources.push_back(makeSource(mixture[j]));
    }
    std::mt19937_64 engine(seed);
    points.reserve(n * D);
    for (std::size_t i = 0; i < n; ++i) {
        const auto chosen =
            std::lower_bound(cumulative.begin(), cumulative.end(), uniform(engine) * total);
        const Source<D>& source = sources[chosen - cumulative.begin()];
        typename Gaussian<D>::Vector normal;
        for (int a = 0; a < D; ++a) normal[a] = standardNormal(engine);
        const typename Gaussian<D>::Vector x = source.mean + source.root * normal;
        for (int a = 0; a < D; ++a) points.push_back(static_cast<float>(x[a]));
    }
    return points;
}

template std::vector<float> samplePoints(const Mixture<3>&, std::size_t, std::uint64_t);

}  // namespace hgmm
