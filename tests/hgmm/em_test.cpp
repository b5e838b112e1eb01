#include "hgmm/em.h"

#include <gtest/gtest.h>
#include <omp.h>

#include <cmath>
#include <limits>
#include <random>
#include <stdexcept>
#include <string>
#include <vector>

#include "overestimate.h"
#include "planted_mixture.h"

namespace hgmm::test {
namespace {

EmParams iterations(int count) {
    EmParams params;
    params.maxIterations = count;
    params.minImprovement = 0;
    return params;
}

template <int D>
Mixture<D> plantedSamples(std::uint64_t seed, double noiseStd) {
    std::mt19937_64 engine(seed);
    Planting planting;
    planting.components = 5;
    const Mixture<D> truth = plantMixture<D>(planting, engine);
    return asSamples<D>(drawPoints(truth, 600, seed), noiseStd);
}

template <int D>
void expectLikelihoodNeverFalls(double noiseStd) {
    for (std::uint64_t seed = 1; seed <= 8; ++seed) {
        const Mixture<D> samples = plantedSamples<D>(seed, noiseStd);
        std::mt19937_64 engine(seed);
        const Overestimate<D> guess = overestimate(samples, 12, 4, engine);
        for (const bool sparse : {false, true}) {
            const EmResult<D> fit = sparse
                                        ? fitSparse(samples, guess.mixture,
                                                    guess.neighbourhoods, iterations(25))
                                        : fitDense(samples, guess.mixture, iterations(25));
            ASSERT_GE(fit.logLikelihood.size(), 2u);
            for (std::size_t k = 1; k < fit.logLikelihood.size(); ++k)
                EXPECT_GE(fit.logLikelihood[k], fit.logLikelihood[k - 1] - 1e-7)
                    << "D " << D << " seed " << seed << " iteration " << k;
            EXPECT_GT(fit.logLikelihood.back(), fit.logLikelihood.front());
            EXPECT_NO_THROW(fit.mixture.check());
            EXPECT_NEAR(fit.mixture.totalSupport(), samples.totalSupport(), 1e-3);
        }
    }
}

TEST(Em, LikelihoodNeverFallsWithSampleNoise) {
    expectLikelihoodNeverFalls<2>(0.02);
    expectLikelihoodNeverFalls<3>(0.02);
}

TEST(Em, LikelihoodNeverFallsWithRawPoints) {
    expectLikelihoodNeverFalls<2>(0);
    expectLikelihoodNeverFalls<3>(0);
}

/// Parameters after one iteration, straight from eq. (3.8)-(3.12) without logarithms.
template <int D>
Mixture<D> oneNaiveIteration(const Mixture<D>& points, const Mixture<D>& initial) {
    using Vector = Eigen::Matrix<double, D, 1>;
    using Matrix = Eigen::Matrix<double, D, D>;
    const double total = initial.totalSupport();
    const std::size_t J = initial.size();
    std::vector<double> weight(J, 0);
    std::vector<Vector> first(J, Vector::Zero());
    std::vector<Matrix> second(J, Matrix::Zero());
    for (std::size_t i = 0; i < points.size(); ++i) {
        const Vector z = points[i].mean;
        std::vector<double> density(J);
        double sum = 0;
        for (std::size_t j = 0; j < J; ++j) {
            const Gaussian<D> g = initial[j];
            const Matrix S = g.covariance;
            const Vector d = z - g.mean;
            density[j] = g.support / total * std::exp(-0.5 * d.dot(S.inverse() * d)) /
                         std::sqrt(std::pow(2 * M_PI, D) * S.determinant());
            sum += density[j];
        }
        for (std::size_t j = 0; j < J; ++j) {
            weight[j] += density[j] / sum;
            first[j] += density[j] / sum * z;
            second[j] += density[j] / sum * z * z.transpose();
        }
    }
    Mixture<D> out;
    for (std::size_t j = 0; j < J; ++j) {
        const Vector mean = first[j] / weight[j];
        out.pushBack({weight[j], mean, second[j] / weight[j] - mean * mean.transpose()});
    }
    return out;
}

template <int D>
void expectSame(const Mixture<D>& a, const Mixture<D>& b, double tolerance) {
    ASSERT_EQ(a.size(), b.size());
    for (std::size_t j = 0; j < a.size(); ++j) {
        EXPECT_NEAR(a.support[j], b.support[j], tolerance * b.support[j]);
        EXPECT_LT((a[j].mean - b[j].mean).norm(), tolerance);
        EXPECT_LT((a[j].covariance - b[j].covariance).norm(), tolerance);
    }
}

TEST(Em, DenseIterationMatchesTheEquations) {
    const Mixture<3> points = plantedSamples<3>(3, 0);
    Mixture<3> initial;
    for (int j = 0; j < 5; ++j)
        initial.pushBack({1.0 + j, points[100 * j].mean, Gaussian<3>::Matrix::Identity()});
    const EmResult<3> fit = fitDense(points, initial, iterations(1));
    expectSame(fit.mixture, oneNaiveIteration(points, initial), 1e-4);
}

TEST(Em, SparseWithAllNeighboursIsDense) {
    const Mixture<3> samples = plantedSamples<3>(4, 0.05);
    std::mt19937_64 engine(4);
    const Overestimate<3> guess = overestimate(samples, 7, 7, engine);
    const auto dense = fitDense(samples, guess.mixture, iterations(5));
    const auto sparse =
        fitSparse(samples, guess.mixture, guess.neighbourhoods, iterations(5));
    EXPECT_TRUE(dense.mixture == sparse.mixture);
    EXPECT_EQ(dense.logLikelihood, sparse.logLikelihood);
}

TEST(Em, RecoversAPlantedMixture) {
    Mixture<3> truth;
    std::mt19937_64 engine(11);
    for (int j = 0; j < 4; ++j) {
        Gaussian<3> g;
        g.support = 1000 * (j + 1);
        g.mean = Eigen::Vector3d(8.0 * (j % 2), 8.0 * (j / 2), j);
        g.covariance = randomCovariance<3>(engine, 10);
        truth.pushBack(g);
    }
    const Mixture<3> points = asSamples<3>(drawPoints(truth, 20000, 5), 0);
    Mixture<3> initial;  // 1 m off and round
    for (int j = 0; j < 4; ++j)
        initial.pushBack({1.0, truth[j].mean + Gaussian<3>::Vector::Constant(0.6),
                          Gaussian<3>::Matrix::Identity()});
    const EmResult<3> fit = fitDense(points, initial, iterations(20));
    ASSERT_EQ(fit.mixture.size(), 4u);
    for (int j = 0; j < 4; ++j) {
        const double weight = fit.mixture.weight(j, fit.mixture.totalSupport());
        EXPECT_NEAR(weight, 0.1 * (j + 1), 0.015);
        EXPECT_LT((fit.mixture[j].mean - truth[j].mean).norm(), 0.08);
        EXPECT_LT((fit.mixture[j].covariance - truth[j].covariance).norm(),
                  0.1 * truth[j].covariance.norm());
    }
}

TEST(Em, LeafMomentsFitAsTheirPointsDo) {
    // Leaves far apart compared with their size: their points agree on their component.
    std::mt19937_64 engine(2);
    Mixture<2> points, leaves;
    for (int leaf = 0; leaf < 40; ++leaf) {
        const Gaussian<2>::Vector centre(leaf < 20 ? 0.1 * leaf : 50 + 0.1 * leaf,
                                         leaf % 7);
        Gaussian<2> sum;
        for (int k = 0; k < 9; ++k) {
            Gaussian<2> point;
            point.support = 1;
            point.mean =
                centre + 0.02 * Gaussian<2>::Vector(normal(engine), normal(engine));
            points.pushBack(point);
            sum = k == 0 ? point : mergeMoments(sum, point);
        }
        leaves.pushBack(sum);
    }
    Mixture<2> initial;
    initial.pushBack({1, {2, 2}, 4 * Gaussian<2>::Matrix::Identity()});
    initial.pushBack({1, {52, 2}, 4 * Gaussian<2>::Matrix::Identity()});
    const auto byPoints = fitDense(points, initial, iterations(3));
    const auto byLeaves = fitDense(leaves, initial, iterations(3));
    expectSame(byLeaves.mixture, byPoints.mixture, 2e-5);
    EXPECT_NEAR(byLeaves.logLikelihood.back(), byPoints.logLikelihood.back(), 1e-4);
}

TEST(Em, SameForAnyNumberOfThreads) {
    std::mt19937_64 engine(1);
    Planting planting;
    planting.components = 30;
    const Mixture<3> truth = plantMixture<3>(planting, engine);
    const Mixture<3> samples = asSamples<3>(drawPoints(truth, 9000, 1), 0.02);
    const Overestimate<3> guess = overestimate(samples, 60, 30, engine);
    const int before = omp_get_max_threads();
    omp_set_num_threads(1);
    const auto one = fitSparse(samples, guess.mixture, guess.neighbourhoods, iterations(4));
    omp_set_num_threads(3);
    const auto three =
        fitSparse(samples, guess.mixture, guess.neighbourhoods, iterations(4));
    omp_set_num_threads(before);
    EXPECT_TRUE(one.mixture == three.mixture);
    EXPECT_EQ(one.logLikelihood, three.logLikelihood);
}

TEST(Em, ComponentWithoutSupportIsDropped) {
    const Mixture<3> samples = plantedSamples<3>(6, 0.05);
    Mixture<3> initial;
    initial.pushBack({1, {0, 0, 0}, 9 * Gaussian<3>::Matrix::Identity()});
    initial.pushBack({1, {1e4, 0, 0}, 1e-4 * Gaussian<3>::Matrix::Identity()});
    initial.pushBack({1, {2, 2, 2}, 9 * Gaussian<3>::Matrix::Identity()});
    const EmResult<3> fit = fitDense(samples, initial, iterations(4));
    EXPECT_EQ(fit.mixture.size(), 2u);
    EXPECT_NEAR(fit.mixture.totalSupport(), samples.totalSupport(), 1e-3);
}

TEST(Em, SampleStaysWithItsOnlyComponentHoweverFar) {
    Mixture<2> samples, initial;
    samples.pushBack({5, {0, 0}, 1e-4 * Gaussian<2>::Matrix::Identity()});
    samples.pushBack({3, {1e5, 0}, 1e-4 * Gaussian<2>::Matrix::Identity()});
    initial.pushBack({1, {0, 0}, 1e-4 * Gaussian<2>::Matrix::Identity()});
    initial.pushBack({1, {1, 0}, 1e-4 * Gaussian<2>::Matrix::Identity()});
    const Neighbourhoods own{{0, 1, 2}, {0, 1}};
    const EmResult<2> fit = fitSparse(samples, initial, own, iterations(3));
    ASSERT_EQ(fit.mixture.size(), 2u);
    EXPECT_FLOAT_EQ(fit.mixture.support[1], 3);
    EXPECT_FLOAT_EQ(fit.mixture.mean[0][1], 1e5F);
    for (const double value : fit.logLikelihood) EXPECT_TRUE(std::isfinite(value));
}

TEST(Em, ZeroIterationsKeepTheMixture) {
    const Mixture<3> samples = plantedSamples<3>(6, 0.05);
    Mixture<3> initial;
    initial.pushBack({1, {0, 0, 0}, Gaussian<3>::Matrix::Identity()});
    initial.pushBack({3, {2, 0, 0}, Gaussian<3>::Matrix::Identity()});
    const EmResult<3> fit = fitDense(samples, initial, iterations(0));
    EXPECT_EQ(fit.logLikelihood.size(), 1u);
    EXPECT_EQ(fit.mixture.mean, initial.mean);
    EXPECT_FLOAT_EQ(fit.mixture.support[1], 450);
}

TEST(Em, StopsWhenTheGainIsSmall) {
    const Mixture<3> samples = plantedSamples<3>(8, 0.05);
    std::mt19937_64 engine(8);
    const Overestimate<3> guess = overestimate(samples, 10, 10, engine);
    EmParams params = iterations(200);
    params.minImprovement = 0.01;
    const auto& gains = fitDense(samples, guess.mixture, params).logLikelihood;
    ASSERT_LT(gains.size(), 200u);
    EXPECT_LT(gains.back() - gains[gains.size() - 2], 0.01);
    for (std::size_t k = 1; k + 1 < gains.size(); ++k)
        EXPECT_GE(gains[k] - gains[k - 1], 0.01);
}

/// Samples without extent in 3, 2, 1 and 0 directions.
Mixture<3> degenerateSamples(int rank) {
    std::mt19937_64 engine(rank);
    Mixture<3> samples;
    for (int i = 0; i < 50; ++i) {
        Gaussian<3> g;
        g.support = 1;
        g.mean = {7, -3, 100};
        for (int a = 0; a < rank; ++a)
            g.mean += normal(engine) * Eigen::Vector3d(1, a == 1 ? -1 : 0.3, 0.5);
        samples.pushBack(g);
    }
    return samples;
}

TEST(Em, DegenerateSamplesGiveAProperMixture) {
    for (int rank = 0; rank <= 2; ++rank) {
        const Mixture<3> samples = degenerateSamples(rank);
        Mixture<3> initial;
        for (int j = 0; j < 3; ++j)
            initial.pushBack({1, samples[j].mean, 0.1 * Gaussian<3>::Matrix::Identity()});
        const EmResult<3> fit = fitDense(samples, initial, iterations(30));
        EXPECT_NO_THROW(fit.mixture.check()) << "rank " << rank;
        for (std::size_t k = 0; k < fit.logLikelihood.size(); ++k) {
            EXPECT_TRUE(std::isfinite(fit.logLikelihood[k]));
            if (k > 0) {
                EXPECT_GE(fit.logLikelihood[k], fit.logLikelihood[k - 1] - 1e-5);
            }
        }
    }
}

TEST(Em, OneSample) {
    Mixture<3> samples;
    samples.pushBack({2, Gaussian<3>::Vector::Ones(), Gaussian<3>::Matrix::Zero()});
    Mixture<3> initial;
    initial.pushBack({1, Gaussian<3>::Vector::Zero(), Gaussian<3>::Matrix::Identity()});
    const EmResult<3> fit = fitDense(samples, initial, iterations(5));
    ASSERT_EQ(fit.mixture.size(), 1u);
    EXPECT_NO_THROW(fit.mixture.check());
    EXPECT_FLOAT_EQ(fit.mixture.support[0], 2);
    EXPECT_FLOAT_EQ(fit.mixture.mean[2][0], 1);
}

TEST(Em, NoSamplesGiveNoMixture) {
    EXPECT_TRUE(fitDense(Mixture<3>{}, Mixture<3>{}, EmParams{}).mixture.empty());
    EXPECT_THROW(fitDense(plantedSamples<3>(1, 0), Mixture<3>{}, EmParams{}),
                 std::invalid_argument);
}

TEST(Em, WrongNeighbourhoodsThrow) {
    Mixture<2> samples, initial;
    for (int i = 0; i < 2; ++i) {
        samples.pushBack({1, {double(i), 0}, Gaussian<2>::Matrix::Identity()});
        initial.pushBack({1, {double(i), 0}, Gaussian<2>::Matrix::Identity()});
    }
    const auto fit = [&](const Neighbourhoods& n) {
        fitSparse(samples, initial, n, EmParams{});
    };
    EXPECT_NO_THROW(fit({{0, 1, 3}, {0, 0, 1}}));
    EXPECT_THROW(fit({{0, 1}, {0}}), std::invalid_argument);           // a sample short
    EXPECT_THROW(fit({{0, 2, 2}, {0, 1}}), std::invalid_argument);     // one without any
    EXPECT_THROW(fit({{0, 1, 2}, {0, 2}}), std::invalid_argument);     // no such component
    EXPECT_THROW(fit({{0, 1, 3}, {0, 1, 0}}), std::invalid_argument);  // falling
    EXPECT_THROW(fit({{0, 3, 2}, {0, 1}}), std::invalid_argument);     // begin falls
    EXPECT_THROW(fit({{0, 9, 2}, {0, 1}}), std::invalid_argument);     // beyond the end
}

void expectNames(const EmParams& params, const std::string& field) {
    try {
        params.validate();
        FAIL() << "accepted a wrong " << field;
    } catch (const std::invalid_argument& e) {
        EXPECT_NE(std::string(e.what()).find(field), std::string::npos) << e.what();
    }
}

TEST(Em, WrongParamsAreNamed) {
    EXPECT_NO_THROW(EmParams{}.validate());
    EmParams params;
    params.maxIterations = -1;
    expectNames(params, "maxIterations");
    for (const double wrong :
         {-1e-3, std::nan(""), std::numeric_limits<double>::infinity()}) {
        params = EmParams{};
        params.minImprovement = wrong;
        expectNames(params, "minImprovement");
        EXPECT_THROW(fitDense(Mixture<2>{}, Mixture<2>{}, params), std::invalid_argument);
    }
}

TEST(LogDensity, MatchesTheFormula) {
    Mixture<2> mixture;
    mixture.pushBack({3, {0, 0}, Gaussian<2>::Matrix::Identity()});
    mixture.pushBack({1, {1, 0}, 0.25 * Gaussian<2>::Matrix::Identity()});
    const double x[2] = {0.5, 0.5};
    const double expected =
        0.75 * std::exp(-0.25) / (2 * M_PI) + 0.25 * std::exp(-1.0) / (2 * M_PI * 0.25);
    EXPECT_NEAR(logDensity(mixture, x), std::log(expected), 1e-6);
}

TEST(LogDensity, IsFiniteFarAway) {
    Mixture<2> mixture;
    mixture.pushBack({3, {0, 0}, 1e-4 * Gaussian<2>::Matrix::Identity()});
    mixture.pushBack({1, {1e3, 0}, 1e-4 * Gaussian<2>::Matrix::Identity()});
    const double x[2] = {1e6, 0};
    const double nearest =
        std::log(0.25 / (2 * M_PI * 1e-4)) - 0.5 * std::pow(999e3, 2) / 1e-4;
    EXPECT_NEAR(logDensity(mixture, x) / nearest, 1, 1e-6);
    EXPECT_THROW(logDensity(Mixture<2>{}, x), std::invalid_argument);
}

}  // namespace
}  // namespace hgmm::test
