#pragma once
#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <random>
#include <vector>

#include "hgmm/mixture.h"

namespace hgmm::test {

inline double uniform(std::mt19937_64& engine, double low, double high) {
    return low + (high - low) * (static_cast<double>(engine() >> 11) * 0x1p-53);
}

inline double normal(std::mt19937_64& engine) {
    return std::sqrt(-2 * std::log(1 - uniform(engine, 0, 1))) *
           std::cos(6.283185307179586 * uniform(engine, 0, 1));
}

/// Random orientation; standard deviations between longest / maxRatio and longest, where
/// the longest lies in [0.5, 1].
template <int D>
typename Gaussian<D>::Matrix randomCovariance(std::mt19937_64& engine, double maxRatio) {
    using Matrix = Eigen::Matrix<double, D, D>;
    Matrix axes;  // Gram-Schmidt on random directions
    for (int a = 0; a < D; ++a) {
        for (int k = 0; k < D; ++k) axes(k, a) = normal(engine);
        for (int b = 0; b < a; ++b)
            axes.col(a) -= axes.col(a).dot(axes.col(b)) * axes.col(b);
        axes.col(a).normalize();
    }
    Eigen::Matrix<double, D, 1> sigma;
    sigma[0] = uniform(engine, 0.5, 1.0);
    for (int a = 1; a < D; ++a)
        sigma[a] = sigma[0] * std::exp(-uniform(engine, 0, std::log(maxRatio)));
    return axes * sigma.cwiseAbs2().asDiagonal() * axes.transpose();
}

/// n points from a mixture; axis d of point i is at [i * D + d]. For any D, and not by
/// samplePoints(), which the library has for D = 3.
template <int D>
std::vector<float> drawPoints(const Mixture<D>& mixture, std::size_t n,
                              std::uint64_t seed) {
    using Matrix = Eigen::Matrix<double, D, D>;
    using Vector = Eigen::Matrix<double, D, 1>;
    std::mt19937_64 engine(seed);
    std::vector<Matrix> roots;
    for (std::size_t j = 0; j < mixture.size(); ++j)
        roots.push_back(Eigen::LLT<Matrix>(Matrix(mixture[j].covariance)).matrixL());
    const double total = mixture.totalSupport();
    std::vector<float> points;
    points.reserve(n * D);
    for (std::size_t i = 0; i < n; ++i) {
        double left = uniform(engine, 0, total);
        std::size_t j = 0;
        while (j + 1 < mixture.size() && (left -= mixture.support[j]) > 0) ++j;
        Vector z;
        for (int a = 0; a < D; ++a) z[a] = normal(engine);
        const Vector x = roots[j] * z;
        for (int a = 0; a < D; ++a)
            points.push_back(static_cast<float>(mixture.mean[a][j] + x[a]));
    }
    return points;
}

/// Distance of two means under the mean of the two covariances [sigma].
template <int D>
double separation(const Gaussian<D>& a, const Gaussian<D>& b) {
    using Matrix = Eigen::Matrix<double, D, D>;
    using Vector = Eigen::Matrix<double, D, 1>;
    const Matrix between = 0.5 * (a.covariance + b.covariance);
    const Vector d = a.mean - b.mean;
    return std::sqrt(d.dot(Eigen::LDLT<Matrix>(between).solve(d)));
}

struct Planting {
    std::size_t components = 10;
    double nearest = 3,
           farthest = 6;   ///< separation of a component from its neighbour [sigma]
    double maxRatio = 20;  ///< of standard deviations within one component
    double minSupport = 200, maxSupport = 400;  ///< points per component
};

/// Each new component stands nearest..farthest sigma from one before it, and at least
/// nearest from all others.
template <int D>
Mixture<D> plantMixture(const Planting& planting, std::mt19937_64& engine) {
    std::vector<Gaussian<D>> planted;
    while (planted.size() < planting.components) {
        Gaussian<D> g;
        g.support = std::floor(uniform(engine, planting.minSupport, planting.maxSupport));
        g.covariance = randomCovariance<D>(engine, planting.maxRatio);
        bool free = true;
        if (!planted.empty()) {
            const Gaussian<D>& neighbour = planted[engine() % planted.size()];
            for (int a = 0; a < D; ++a) g.mean[a] = neighbour.mean[a] + normal(engine);
            const double wanted = uniform(engine, planting.nearest, planting.farthest);
            g.mean = neighbour.mean +
                     wanted / separation(g, neighbour) * (g.mean - neighbour.mean).eval();
            for (const Gaussian<D>& other : planted)
                free = free && separation(g, other) >= planting.nearest * (1 - 1e-9);
        }
        if (free) planted.push_back(g);
    }
    Mixture<D> mixture;
    for (const Gaussian<D>& g : planted) mixture.pushBack(g);
    return mixture;
}

/// Points as samples of support 1 with isotropic noise.
template <int D>
Mixture<D> asSamples(const std::vector<float>& points, double noiseStd) {
    Mixture<D> samples;
    Gaussian<D> g;
    g.support = 1;
    g.covariance = noiseStd * noiseStd * Gaussian<D>::Matrix::Identity();
    for (std::size_t i = 0; i < points.size() / D; ++i) {
        for (int a = 0; a < D; ++a) g.mean[a] = points[i * D + a];
        samples.pushBack(g);
    }
    return samples;
}

}  // namespace hgmm::test
