#include "hgmm/sampling.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <stdexcept>
#include <vector>

#include "planted_mixture.h"

namespace hgmm::test {
namespace {

/// Moments of draws from one component against its parameters, within 5 standard errors.
TEST(SamplePoints, HaveTheMomentsOfTheirComponent) {
    constexpr int D = 3;
    std::mt19937_64 engine(D);
    Gaussian<D> g{1, Gaussian<D>::Vector::Constant(3), randomCovariance<D>(engine, 10)};
    Mixture<D> mixture;
    mixture.pushBack(g);
    const std::size_t n = 40000;
    const Mixture<D> draws = asSamples<D>(samplePoints<D>(mixture, n, 1), 0);
    ASSERT_EQ(draws.size(), n);
    Gaussian<D> all = draws[0];
    for (std::size_t i = 1; i < n; ++i) all = mergeMoments(all, draws[i]);
    for (int a = 0; a < D; ++a) {
        EXPECT_NEAR(all.mean[a], g.mean[a], 5 * std::sqrt(g.covariance(a, a) / n));
        for (int b = 0; b < D; ++b) {
            const double spread = g.covariance(a, a) * g.covariance(b, b) +
                                  g.covariance(a, b) * g.covariance(a, b);
            EXPECT_NEAR(all.covariance(a, b), g.covariance(a, b),
                        5 * std::sqrt(spread / n));
        }
    }
}

Mixture<3> twoSpots() {
    Mixture<3> mixture;
    mixture.pushBack({1, {0, 0, 0}, 1e-4 * Gaussian<3>::Matrix::Identity()});
    mixture.pushBack({3, {10, 0, 0}, 1e-4 * Gaussian<3>::Matrix::Identity()});
    return mixture;
}

TEST(SamplePoints, FollowTheWeights) {
    const std::vector<float> x = samplePoints<3>(twoSpots(), 10000, 4);
    int second = 0;
    for (std::size_t i = 0; i < x.size(); i += 3) second += x[i] > 5;
    EXPECT_NEAR(second / 10000.0, 0.75, 5 * std::sqrt(0.75 * 0.25 / 10000));
}

TEST(SamplePoints, AreTheSameForTheSameSeedOnly) {
    EXPECT_EQ(samplePoints<3>(twoSpots(), 100, 4), samplePoints<3>(twoSpots(), 100, 4));
    EXPECT_NE(samplePoints<3>(twoSpots(), 100, 4), samplePoints<3>(twoSpots(), 100, 5));
}

TEST(SamplePoints, StayOnAComponentWithoutExtent) {
    Mixture<3> mixture;
    Gaussian<3> line{1, {1, 2, 3}, Gaussian<3>::Matrix::Zero()};
    line.covariance(1, 1) = 4;
    mixture.pushBack(line);
    const std::vector<float> x = samplePoints<3>(mixture, 100, 1);
    for (std::size_t i = 0; i < x.size(); i += 3) {
        EXPECT_EQ(x[i], 1.F);
        EXPECT_TRUE(std::isfinite(x[i + 1]));
        EXPECT_EQ(x[i + 2], 3.F);
    }
}

TEST(SamplePoints, OfNothing) {
    EXPECT_TRUE(samplePoints<3>(Mixture<3>{}, 0, 1).empty());
    EXPECT_THROW(samplePoints<3>(Mixture<3>{}, 1, 1), std::invalid_argument);
}

}  // namespace
}  // namespace hgmm::test
