#include "hgmm/divergence.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <iostream>
#include <limits>
#include <random>
#include <stdexcept>
#include <string>
#include <vector>

#include "hgmm/gaussian.h"
#include "mixture/goldberger.h"
#include "planted_mixture.h"

namespace hgmm::test {
namespace {

constexpr std::size_t kDraws = 20000;

/// A mixture factored once, for Monte-Carlo.
template <int D>
class Density {
 public:
    explicit Density(const Mixture<D>& mixture) {
        for (std::size_t j = 0; j < mixture.size(); ++j) {
            terms_.emplace_back(mixture[j]);
            logWeights_.push_back(std::log(mixture.weight(j, mixture.totalSupport())));
        }
    }
    double log(const float* x) const {
        std::array<double, D> point;
        std::copy(x, x + D, point.begin());
        double sum = -std::numeric_limits<double>::infinity();
        for (std::size_t j = 0; j < terms_.size(); ++j)
            sum = logAddExp(sum, logWeights_[j] + terms_[j].logPdf(point.data()));
        return sum;
    }

 private:
    std::vector<WhitenedGaussian<D>> terms_;
    std::vector<double> logWeights_;
};

/// Mean of f over draws from p, and its standard error.
struct Estimate {
    double mean, error;
};

template <int D, typename Function>
Estimate monteCarlo(const Mixture<D>& p, std::uint64_t seed, Function f) {
    const std::vector<float> draws = drawPoints(p, kDraws, seed);
    double sum = 0, squares = 0;
    for (std::size_t i = 0; i < kDraws; ++i) {
        const double value = f(&draws[i * D]);
        sum += value;
        squares += value * value;
    }
    const double mean = sum / kDraws;
    return {mean, std::sqrt((squares / kDraws - mean * mean) / kDraws)};
}

template <int D>
Mixture<D> randomMixture(std::uint64_t seed, std::size_t size, double maxRatio = 4) {
    std::mt19937_64 engine(seed);
    Mixture<D> mixture;
    for (std::size_t j = 0; j < size; ++j) {
        Gaussian<D> g;
        g.support = 1 + engine() % 5;
        for (int a = 0; a < D; ++a) g.mean[a] = normal(engine);
        g.covariance = randomCovariance<D>(engine, maxRatio);
        mixture.pushBack(g);
    }
    return mixture;
}

template <int D>
void expectKlMatchesMonteCarlo() {
    for (std::uint64_t seed = 1; seed <= 5; ++seed) {
        const Mixture<D> f = randomMixture<D>(seed, 1), g = randomMixture<D>(seed + 50, 1);
        const Density<D> logF(f), logG(g);
        const Estimate estimate =
            monteCarlo(f, seed, [&](const float* x) { return logF.log(x) - logG.log(x); });
        EXPECT_NEAR(klDivergence(f[0], g[0]), estimate.mean, 5 * estimate.error)
            << "D " << D << " seed " << seed;
    }
}

TEST(KlDivergence, OfGaussiansMatchesMonteCarlo) {
    expectKlMatchesMonteCarlo<2>();
    expectKlMatchesMonteCarlo<3>();
    expectKlMatchesMonteCarlo<4>();
}

TEST(KlDivergence, OfGaussiansIsInNats) {
    Gaussian<3> f{1, {0, 0, 0}, Gaussian<3>::Matrix::Identity()}, g = f;
    EXPECT_EQ(klDivergence(f, f), 0);
    g.mean = {2, 0, 0};
    EXPECT_NEAR(klDivergence(f, g), 2, 1e-12);  // |d|^2 / 2
    g.covariance *= 4;
    EXPECT_NEAR(klDivergence(f, g), 0.5 * (std::log(64.0) + 0.75 + 1 - 3), 1e-12);
}

TEST(KlDivergence, OfDegenerateGaussiansIsFinite) {
    Gaussian<3> f, g;
    g.mean = {1, 0, 0};
    EXPECT_EQ(klDivergence(f, f), 0);
    EXPECT_TRUE(std::isfinite(klDivergence(f, g)));
    g.covariance(0, 0) = 1;
    EXPECT_TRUE(std::isfinite(klDivergence(f, g)));
    EXPECT_TRUE(std::isfinite(klDivergence(g, f)));
}

/// Eq. (3.15) word for word, with inverses and determinants.
template <int D>
double naiveGoldberger(const Mixture<D>& p, const Mixture<D>& q) {
    using Matrix = Eigen::Matrix<double, D, D>;
    using Vector = Eigen::Matrix<double, D, 1>;
    double sum = 0;
    for (std::size_t i = 0; i < p.size(); ++i) {
        double least = std::numeric_limits<double>::infinity();
        const double pi = p.weight(i, p.totalSupport());
        const Matrix S = p[i].covariance;
        for (std::size_t j = 0; j < q.size(); ++j) {
            const Matrix T = q[j].covariance, inverse = T.inverse();
            const Vector d = p[i].mean - q[j].mean;
            const double kl = 0.5 * (std::log(T.determinant() / S.determinant()) +
                                     (inverse * S).trace() + d.dot(inverse * d) - D);
            least = std::min(least, kl + std::log(pi / q.weight(j, q.totalSupport())));
        }
        sum += pi * least;
    }
    return sum;
}

/// The search behind klDivergence(Mixture), for any D.
template <int D>
double goldberger(const Mixture<D>& p, const Mixture<D>& q) {
    const GoldbergerSearch<D> search(q);
    double sum = 0;
    for (std::size_t i = 0; i < p.size(); ++i) {
        const double weight = p.weight(i, p.totalSupport());
        GoldbergerMatch best;
        search.improve(PreparedGaussian<D>(p[i]), std::log(weight), best);
        sum += weight * best.cost;
    }
    return sum;
}

template <int D>
void expectGoldbergerIsExact() {
    for (std::uint64_t seed = 1; seed <= 10; ++seed) {
        const Mixture<D> p = randomMixture<D>(seed, 40, 20),
                         q = randomMixture<D>(seed + 9, 25, 20);
        EXPECT_NEAR(goldberger(p, q), naiveGoldberger(p, q), 1e-8);
        EXPECT_NEAR(goldberger(q, p), naiveGoldberger(q, p), 1e-8);
        EXPECT_LE(goldberger(p, p),
                  1e-12);  // a heavier neighbour can beat the component itself
    }
}

TEST(KlDivergence, OfMixturesIsGoldbergers) {
    expectGoldbergerIsExact<2>();
    expectGoldbergerIsExact<3>();
    const Mixture<3> p = randomMixture<3>(1, 40, 20), q = randomMixture<3>(2, 25, 20);
    EXPECT_EQ(klDivergence(p, q), goldberger(p, q));
}

TEST(KlDivergence, OfSpreadMixturesIsGoldbergers) {
    // Far-flung components, where the search stops early, and very different weights.
    std::mt19937_64 engine(3);
    Planting planting;
    planting.components = 60;
    planting.minSupport = 1;
    planting.maxSupport = 5000;
    const Mixture<3> p = plantMixture<3>(planting, engine),
                     q = plantMixture<3>(planting, engine);
    EXPECT_NEAR(klDivergence(p, q) / naiveGoldberger(p, q), 1, 1e-9);
}

/// The approximation has no known error; its gap to the truth is put on record.
TEST(KlDivergence, GapOfGoldbergersApproximation) {
    double gap = 0, largest = 0;
    for (std::uint64_t seed = 1; seed <= 10; ++seed) {
        const Mixture<3> p = randomMixture<3>(seed, 8), q = randomMixture<3>(seed + 70, 8);
        const Density<3> logP(p), logQ(q);
        const Estimate truth =
            monteCarlo(p, seed, [&](const float* x) { return logP.log(x) - logQ.log(x); });
        const double difference = klDivergence(p, q) - truth.mean;
        gap += difference / 10;
        largest = std::max(largest, std::abs(difference));
        EXPECT_GT(klDivergence(p, q), truth.mean - 3 * truth.error - std::log(8.0));
    }
    std::cout << "Goldberger's KL minus Monte-Carlo: mean " << gap << ", largest "
              << largest << " nat over 10 pairs of overlapping mixtures of 8\n";
    RecordProperty("mean_gap_nat", std::to_string(gap));
    RecordProperty("largest_gap_nat", std::to_string(largest));
}

TEST(SampledKlDivergence, OfGaussiansIsAnalytic) {
    for (std::uint64_t seed = 1; seed <= 5; ++seed) {
        const Mixture<3> f = randomMixture<3>(seed, 1), g = randomMixture<3>(seed + 50, 1);
        const SampledDivergence kl = sampledKlDivergence(f, g, 20000, seed);
        EXPECT_NEAR(kl.value, klDivergence(f[0], g[0]), 5 * kl.error) << "seed " << seed;
        EXPECT_GT(kl.error, 0);
        EXPECT_LT(kl.error, 0.2 * klDivergence(f[0], g[0]));
    }
}

TEST(SampledKlDivergence, OfMixturesIsThatOfADenseSum) {
    for (std::uint64_t seed = 1; seed <= 5; ++seed) {
        const Mixture<3> p = randomMixture<3>(seed, 8), q = randomMixture<3>(seed + 70, 3);
        const Density<3> logP(p), logQ(q);
        const Estimate truth = monteCarlo(
            p, seed + 9, [&](const float* x) { return logP.log(x) - logQ.log(x); });
        const SampledDivergence kl = sampledKlDivergence(p, q, 20000, seed);
        EXPECT_NEAR(kl.value, truth.mean, 5 * std::hypot(kl.error, truth.error));
    }
}

/// Halves of one Gaussian, merged: the mixtures hardly differ, and Goldberger's value is
/// below zero.
TEST(SampledKlDivergence, IsNotNegativeWhereGoldbergersIs) {
    Mixture<3> p, q;
    for (const double x : {-0.05, 0.05})
        p.pushBack({1, {x, 0, 0}, Gaussian<3>::Matrix::Identity()});
    q.pushBack(mergeMoments(p[0], p[1]));
    ASSERT_LT(klDivergence(p, q), -0.6);
    for (std::uint64_t seed = 1; seed <= 20; ++seed) {
        const SampledDivergence kl = sampledKlDivergence(p, q, 500, seed);
        EXPECT_GE(kl.value, 0);
        EXPECT_LT(kl.value, 1e-3);
    }
    EXPECT_EQ(sampledKlDivergence(p, p, 500, 1).value, 0);
}

TEST(SampledKlDivergence, IsFiniteFarApartAndReproducible) {
    Mixture<3> p, q;
    p.pushBack({1, {0, 0, 0}, 1e-4 * Gaussian<3>::Matrix::Identity()});
    q.pushBack({1, {10, 0, 0}, 1e-4 * Gaussian<3>::Matrix::Identity()});
    const SampledDivergence kl = sampledKlDivergence(p, q, 1000, 3);
    EXPECT_NEAR(kl.value, 0.5 * 100 / 1e-4, 5 * kl.error);
    EXPECT_EQ(sampledKlDivergence(p, q, 1000, 3).value, kl.value);
    EXPECT_NE(sampledKlDivergence(p, q, 1000, 4).value, kl.value);
}

/// Eq. (3.17) / 2 by Monte-Carlo: <p,q> = E_p[q], <p,p> = E_p[p], <q,q> = E_q[q].
TEST(CauchySchwarz, MatchesMonteCarlo) {
    for (std::uint64_t seed = 1; seed <= 5; ++seed) {
        const Mixture<3> p = randomMixture<3>(seed, 4), q = randomMixture<3>(seed + 30, 3);
        const Density<3> logP(p), logQ(q);
        const auto valueOf = [](const Density<3>& density) {
            return [&density](const float* x) { return std::exp(density.log(x)); };
        };
        const Estimate pq = monteCarlo(p, 3 * seed, valueOf(logQ));
        const Estimate pp = monteCarlo(p, 3 * seed + 1, valueOf(logP));
        const Estimate qq = monteCarlo(q, 3 * seed + 2, valueOf(logQ));
        const double expected = 0.5 * std::log(pp.mean * qq.mean / (pq.mean * pq.mean));
        const double error = std::hypot(pq.error / pq.mean, 0.5 * pp.error / pp.mean,
                                        0.5 * qq.error / qq.mean);
        EXPECT_NEAR(cauchySchwarzDivergence(p, q), expected, 5 * error) << "seed " << seed;
    }
}

TEST(CauchySchwarz, OfTwoGaussiansIsAnalytic) {
    // Equal unit covariances at distance d: d^2 / 4.
    Mixture<3> p, q;
    p.pushBack({1, {0, 0, 0}, Gaussian<3>::Matrix::Identity()});
    q.pushBack({7, {2, 0, 0}, Gaussian<3>::Matrix::Identity()});
    EXPECT_NEAR(cauchySchwarzDivergence(p, q), 1, 1e-12);
}

TEST(CauchySchwarz, IsSymmetricAndZeroForTheSame) {
    const Mixture<3> p = randomMixture<3>(1, 9), q = randomMixture<3>(2, 5);
    EXPECT_NEAR(cauchySchwarzDivergence(p, q), cauchySchwarzDivergence(q, p), 1e-12);
    EXPECT_NEAR(cauchySchwarzDivergence(p, p), 0, 1e-12);
    EXPECT_GT(cauchySchwarzDivergence(p, q), 0.01);
}

TEST(CauchySchwarz, IsFiniteForMixturesFarApart) {
    Mixture<3> p, q;
    p.pushBack({1, {0, 0, 0}, 1e-4 * Gaussian<3>::Matrix::Identity()});
    q.pushBack({1, {1e4, 0, 0}, 1e-4 * Gaussian<3>::Matrix::Identity()});
    EXPECT_NEAR(cauchySchwarzDivergence(p, q) / (1e8 / 4e-4), 1, 1e-6);
}

TEST(Divergence, OfNothingThrows) {
    const Mixture<3> some = randomMixture<3>(1, 2), none;
    EXPECT_THROW(klDivergence(some, none), std::invalid_argument);
    EXPECT_THROW(klDivergence(none, some), std::invalid_argument);
    EXPECT_THROW(cauchySchwarzDivergence(none, some), std::invalid_argument);
    EXPECT_THROW(cauchySchwarzDivergence(some, none), std::invalid_argument);
    EXPECT_THROW(sampledKlDivergence(some, none, 10, 1), std::invalid_argument);
    EXPECT_THROW(sampledKlDivergence(none, some, 10, 1), std::invalid_argument);
    EXPECT_THROW(sampledKlDivergence(some, some, 1, 1), std::invalid_argument);
}

}  // namespace
}  // namespace hgmm::test
