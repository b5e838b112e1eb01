#include "hgmm/regression.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

#include "joint_mixture.h"

namespace {

using namespace hgmm;
using test::logJoint;
using test::randomMixture;
constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// Moments and mass of p(x, .) by the trapezoidal rule, which is exact to rounding for
/// smooth functions that vanish at both ends.
struct Integrals {
    double density = 0, mean = 0, variance = 0, mass = 0;
};

template <int D>
Integrals integrate(const Mixture<D>& mixture, const double* x, double low, double high) {
    constexpr int kSteps = 4000;
    const auto over = [&](double from, double to, auto&& f) {
        const double h = (to - from) / kSteps;
        double sum = 0;
        for (int i = 0; i <= kSteps; ++i) {
            const double w = from + i * h;
            sum += (i % kSteps == 0 ? 0.5 : 1.0) * h * f(w) *
                   std::exp(logJoint(mixture, x, w));
        }
        return sum;
    };
    Integrals all;
    all.density = over(-15, 15, [](double) { return 1.0; });
    all.mean = over(-15, 15, [](double w) { return w; }) / all.density;
    all.variance =
        over(-15, 15, [&](double w) { return (w - all.mean) * (w - all.mean); }) /
        all.density;
    all.mass = over(low, high, [](double) { return 1.0; }) / all.density;
    return all;
}

template <int D>
void expectEqualsIntegrals(std::uint64_t seed) {
    const Mixture<D> mixture = randomMixture<D>(7, seed);
    const ConditionalMixture<D> prepared(mixture);
    std::mt19937_64 engine(seed + 1);
    Conditional conditional;
    for (int query = 0; query < 20; ++query) {
        double x[D - 1];
        for (double& v : x) v = test::uniform(engine, -2, 2);
        prepared.at(x, conditional);
        const Integrals expected = integrate<D>(mixture, x, -0.3, 0.4);
        EXPECT_NEAR(conditional.logMarginal(), std::log(expected.density), 1e-9);
        EXPECT_NEAR(conditional.mean(), expected.mean, 1e-8);
        EXPECT_NEAR(conditional.variance(), expected.variance, 1e-8);
        EXPECT_NEAR(conditional.mass(-0.3, 0.4), expected.mass, 1e-6);
        EXPECT_NEAR(conditional.logDensity(0.7),
                    logJoint(mixture, x, 0.7) - std::log(expected.density), 1e-9);
    }
}

}  // namespace

TEST(Conditional, OneComponentByHand) {
    Mixture<2> mixture;
    Gaussian<2> g;
    g.support = 3;
    g.mean << 1, 2;
    g.covariance << 4, 2, 2, 3;
    mixture.pushBack(g);
    const ConditionalMixture<2> prepared(mixture);
    const double x = 3;
    const Conditional conditional = prepared.at(&x);
    // m = 2 + 2/4 (3 - 1), sigma^2 = 3 - 2 2/4.
    EXPECT_NEAR(conditional.mean(), 3, 1e-12);
    EXPECT_NEAR(conditional.variance(), 2, 1e-12);
    EXPECT_NEAR(conditional.logMarginal(), -0.5 * std::log(2 * M_PI * 4) - 0.5, 1e-12);
    EXPECT_NEAR(conditional.mass(-kInfinity, 3), 0.5, 1e-12);
    EXPECT_NEAR(conditional.mass(3 - std::sqrt(2), 3 + std::sqrt(2)), 0.6826894921370859,
                1e-12);
    EXPECT_NEAR(prepared.component(0).slope(0), 0.5, 1e-12);
}

TEST(Conditional, WeightsOfTwoComponentsByHand) {
    Mixture<2> mixture;
    Gaussian<2> g;
    g.covariance << 1, 0, 0, 0.25;
    g.support = 1;
    g.mean << -1, 0;
    mixture.pushBack(g);
    g.support = 3;
    g.mean << 1, 2;
    mixture.pushBack(g);
    const double x = 0;  // in the middle: supports decide
    const Conditional conditional = ConditionalMixture<2>(mixture).at(&x);
    ASSERT_EQ(conditional.terms().size(), 2U);
    EXPECT_NEAR(conditional.terms()[0].weight, 0.25, 1e-12);
    EXPECT_NEAR(conditional.terms()[1].weight, 0.75, 1e-12);
    EXPECT_NEAR(conditional.mean(), 1.5, 1e-12);
    EXPECT_NEAR(conditional.variance(), 0.25 + 0.25 * 0.75 * 4, 1e-12);
}

TEST(Conditional, EqualsNumericIntegrationIn2D) {
    for (std::uint64_t seed = 1; seed <= 3; ++seed) expectEqualsIntegrals<2>(seed);
}

TEST(Conditional, EqualsNumericIntegrationIn4D) {
    expectEqualsIntegrals<4>(4);
}

TEST(Conditional, EqualsMonteCarlo) {
    const Mixture<2> mixture = randomMixture<2>(5, 11);
    const std::vector<float> points = test::drawPoints(mixture, 4000000, 12);
    const double x = 0.2, halfWidth = 0.01;
    double n = 0, sum = 0, sumSquared = 0, inside = 0;
    for (std::size_t i = 0; i < points.size(); i += 2) {
        if (std::abs(points[i] - x) > halfWidth) continue;
        const double w = points[i + 1];
        n += 1;
        sum += w;
        sumSquared += w * w;
        inside += w >= -0.1 && w <= 0.5;
    }
    ASSERT_GT(n, 10000);
    const double mean = sum / n, variance = sumSquared / n - mean * mean;
    const Conditional conditional = ConditionalMixture<2>(mixture).at(&x);
    const double fiveSigma = 5 / std::sqrt(n);
    EXPECT_NEAR(conditional.mean(), mean, fiveSigma * std::sqrt(variance));
    EXPECT_NEAR(conditional.variance(), variance, 2 * fiveSigma * variance);
    EXPECT_NEAR(conditional.mass(-0.1, 0.5), inside / n, 0.5 * fiveSigma);
}

TEST(Conditional, MassesOfAPartitionSumToOneAndTailsKeepTheirDigits) {
    const Mixture<4> mixture = randomMixture<4>(6, 21);
    const ConditionalMixture<4> prepared(mixture);
    const double x[3] = {0.1, -0.4, 0.9};
    const Conditional c = prepared.at(x);
    EXPECT_NEAR(c.mass(-kInfinity, -0.02) + c.mass(-0.02, 0.02) + c.mass(0.02, kInfinity),
                1, 1e-14);
    EXPECT_EQ(c.mass(-kInfinity, kInfinity), 1);
    EXPECT_EQ(c.mass(0.3, 0.3), 0);
    EXPECT_EQ(c.mass(kInfinity, kInfinity), 0);

    Mixture<2> standard;
    Gaussian<2> g;
    g.support = 1;
    g.covariance.setIdentity();
    standard.pushBack(g);
    const double zero = 0;
    const Conditional normal = ConditionalMixture<2>(standard).at(&zero);
    // Q(10), to which 1 - Phi(10) would round to zero.
    EXPECT_NEAR(normal.mass(10, kInfinity) / 7.619853024160527e-24, 1, 1e-10);
    EXPECT_NEAR(normal.mass(-kInfinity, -10) / 7.619853024160527e-24, 1, 1e-10);
    EXPECT_NEAR(normal.mass(10, 11) / 7.619853024160527e-24, 1, 1e-3);
}

TEST(Conditional, StaysFiniteFarFromAllComponents) {
    const Mixture<4> mixture = randomMixture<4>(6, 31);
    const ConditionalMixture<4> prepared(mixture);
    for (const double far : {1e3, 1e6, 1e12, 1e100}) {
        const double x[3] = {far, -far, far};
        const Conditional c = prepared.at(x);
        double sum = 0;
        for (const Conditional::Term& t : c.terms()) sum += t.weight;
        EXPECT_NEAR(sum, 1, 1e-12);
        EXPECT_TRUE(std::isfinite(c.mean()));
        EXPECT_TRUE(std::isfinite(c.variance()));
        EXPECT_GT(c.variance(), 0);
        EXPECT_TRUE(std::isfinite(c.logMarginal()));
        EXPECT_GE(c.mass(-1, 1), 0);
        EXPECT_LE(c.mass(-kInfinity, kInfinity), 1);
    }
}

TEST(Conditional, DegenerateCovariancesGiveFiniteAnswers) {
    Mixture<2> mixture;
    Gaussian<2> g;
    g.support = 1;
    mixture.pushBack(g);  // a point
    g.covariance << 1, 1, 1, 1;
    mixture.pushBack(g);  // a line
    const double x = 0.5;
    const Conditional c = ConditionalMixture<2>(mixture).at(&x);
    EXPECT_NEAR(c.mean(), 0.5, 1e-9);
    EXPECT_GT(c.variance(), 0);
    EXPECT_LT(c.variance(), 1e-9);
}

TEST(Conditional, RefusesBadInput) {
    EXPECT_THROW(ConditionalMixture<2>(Mixture<2>{}), std::invalid_argument);
    const ConditionalMixture<2> prepared(randomMixture<2>(2, 41));
    for (const double bad : {double(NAN), kInfinity, -kInfinity, 1e101})
        EXPECT_THROW(prepared.at(&bad), std::invalid_argument);
    const double x = 0;
    const Conditional c = prepared.at(&x);
    EXPECT_THROW(c.mass(1, 0), std::invalid_argument);
    EXPECT_THROW(c.mass(NAN, 1), std::invalid_argument);
    EXPECT_THROW(c.mass(0, NAN), std::invalid_argument);
}
