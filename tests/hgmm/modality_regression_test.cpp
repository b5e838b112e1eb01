#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <algorithm>
#include <random>

#include "hgmm/regression.h"
#include "modality/modality_group.h"

namespace hgmm {
namespace {

/// Components that overlap, two channels each.
ChannelMixture overlapping(std::size_t components, std::uint64_t seed) {
    std::mt19937_64 random(seed);
    std::normal_distribution<double> normal(0.0, 1.0);
    std::uniform_real_distribution<double> even(0.0, 1.0);
    ChannelMixture mixture(2);
    for (std::size_t i = 0; i < components; ++i) {
        ChannelGaussian g;
        g.place.support = 1 + 50 * even(random);
        Eigen::Matrix3d A;
        for (int k = 0; k < 9; ++k) A(k) = 0.3 * normal(random);
        g.place.covariance = A * A.transpose() + 0.05 * Eigen::Matrix3d::Identity();
        for (int d = 0; d < 3; ++d) g.place.mean[d] = 0.5 * normal(random);
        for (int c = 0; c < 2; ++c) {
            g.fits[c].mean = even(random);
            for (int d = 0; d < 3; ++d) g.fits[c].slope[d] = 0.4 * normal(random);
            g.fits[c].residual = 0.001 + 0.02 * even(random);
        }
        mixture.pushBack(g);
    }
    return mixture;
}

/// Thesis eq. (5.3) to (5.7) written down term by term over the joint covariances, for the
/// components within 3 sigma.
ModalityEstimate reference(const ChannelMixture& mixture, int channel,
                           const Eigen::Vector3d& x) {
    double sumW = 0, first = 0, second = 0;
    for (std::size_t i = 0; i < mixture.size(); ++i) {
        const Gaussian<4> g = mixture[i].joint(channel);
        const Eigen::Matrix3d XX = g.covariance.topLeftCorner<3, 3>();
        const Eigen::Vector3d XL = g.covariance.topRightCorner<3, 1>();
        const Eigen::Vector3d d = x - Eigen::Vector3d(g.mean.head<3>());
        const Eigen::Matrix3d inverse = XX.inverse();
        const double squared = d.dot(inverse * d);
        if (squared > 9) continue;
        const double w = g.support * std::exp(-0.5 * squared) / std::sqrt(XX.determinant());
        const double m = g.mean[3] + XL.dot(inverse * d);
        const double v = g.covariance(3, 3) - XL.dot(inverse * XL);
        sumW += w, first += w * m, second += w * (m * m + v);
    }
    if (sumW == 0) return {};
    const double mean = first / sumW;
    return {mean, second / sumW - mean * mean, true};
}

TEST(ModalityRegression, FollowsEquationsFiveSixAndFiveSeven) {
    const ChannelMixture mixture = overlapping(40, 1);
    const ModalityGroup group({"a", "b"}, mixture);
    std::mt19937_64 random(2);
    std::normal_distribution<double> normal(0.0, 0.7);
    std::size_t known = 0;
    for (int k = 0; k < 2000; ++k) {
        const Eigen::Vector3d x(normal(random), normal(random), normal(random));
        for (int c = 0; c < 2; ++c) {
            const ModalityEstimate expected = reference(mixture, c, x),
                                   actual = group.at(c, x);
            ASSERT_EQ(actual.known, expected.known);
            if (!expected.known) continue;
            ++known;
            // Components at the very edge may be in for one and out for the other.
            EXPECT_NEAR(actual.mean, expected.mean, 1e-3);
            EXPECT_NEAR(actual.variance, expected.variance, 1e-3);
        }
    }
    EXPECT_GT(known, 1000U);
}

TEST(ModalityRegression, AgreesWithTheConditionalOfTheJointMixture) {
    const ChannelMixture mixture = overlapping(3, 5);
    const ModalityGroup group({"a", "b"}, mixture);
    const ConditionalMixture<4> conditional(mixture.joint(1));
    const Eigen::Vector3d x = Eigen::Vector3d(mixture[0].place.mean) * 0.5 +
                              Eigen::Vector3d(mixture[1].place.mean) * 0.5;
    const Conditional there = conditional.at(x.data());
    const ModalityEstimate estimate = group.at(1, x);
    EXPECT_NEAR(estimate.mean, there.mean(), 1e-5);
    EXPECT_NEAR(estimate.variance, there.variance(), 1e-5);
    const ChannelValue asked{1, 0.4};
    EXPECT_NEAR(group.density(&asked, 1, x), std::exp(there.logDensity(0.4)), 1e-4);
}

/// Points drawn from the joint mixture, of which those beside x are looked at.
TEST(ModalityRegression, VarianceIsThatOfSamples) {
    ChannelMixture mixture(1);
    ChannelGaussian g;
    g.place.covariance = Eigen::Vector3d(0.04, 0.04, 0.04).asDiagonal();
    g.place.support = 30;
    g.fits[0] = {0.3, {0.5, 0, 0}, 0.002};
    mixture.pushBack(g);
    g.place.mean = Eigen::Vector3d(0.3, 0, 0);
    g.place.support = 10;
    g.fits[0] = {0.8, {0, -0.4, 0}, 0.01};
    mixture.pushBack(g);
    const ModalityGroup group({"a"}, mixture);

    std::mt19937_64 random(3);
    std::normal_distribution<double> normal(0.0, 1.0);
    std::uniform_real_distribution<double> even(0.0, 40.0);
    const Eigen::Vector3d x(0.15, 0.05, 0);
    double n = 0, sum = 0, squares = 0;
    for (int k = 0; k < 2000000; ++k) {
        const ChannelGaussian c = mixture[even(random) < 30 ? 0 : 1];
        Eigen::Vector3d p = c.place.mean;
        for (int d = 0; d < 3; ++d) p[d] += 0.2 * normal(random);
        if ((p - x).cwiseAbs().maxCoeff() > 0.03) continue;
        const double value = c.fits[0].mean +
                             c.fits[0].slope.dot(p - Eigen::Vector3d(c.place.mean)) +
                             std::sqrt(c.fits[0].residual) * normal(random);
        n += 1, sum += value, squares += value * value;
    }
    ASSERT_GT(n, 2000);
    const double mean = sum / n, variance = squares / n - mean * mean;
    const ModalityEstimate estimate = group.at(0, x);
    EXPECT_NEAR(estimate.mean, mean, 5 * std::sqrt(variance / n) + 0.002);
    EXPECT_NEAR(estimate.variance, variance, 0.05 * variance);
}

TEST(ModalityRegression, WhatIsUnknownAnswersWithAllThatWasMeasured) {
    const ChannelMixture mixture = overlapping(40, 1);
    const ModalityGroup group({"a", "b"}, mixture);
    const ModalityEstimate far = group.at(0, {100, 0, 0});
    EXPECT_FALSE(far.known);
    double total = 0, mean = 0;
    for (std::size_t i = 0; i < mixture.size(); ++i) {
        total += mixture[i].place.support;
        mean += mixture[i].place.support * mixture[i].fits[0].mean;
    }
    EXPECT_NEAR(far.mean, mean / total, 1e-6);
    EXPECT_GT(far.variance, 0);
    EXPECT_FALSE(group.at(0, Eigen::Vector3d::Constant(NAN)).known);
    const ChannelValue asked{0, 0.5};
    EXPECT_EQ(group.density(&asked, 1, {100, 0, 0}), 0);
}

TEST(ModalityRegression, LevelsShrinkAndKeepTheMoments) {
    const ChannelMixture mixture = overlapping(40, 1);
    const ModalityGroup group({"a", "b"}, mixture);
    const ModalityMap map(group, 1, HierarchyParams());
    EXPECT_EQ(map.name(), "b");
    EXPECT_EQ(map.mixture(0).size(), 40U);
    for (std::size_t level = 1; level < 5; ++level) {
        EXPECT_LT(map.mixture(level).size(), map.mixture(level - 1).size());
        EXPECT_NEAR(map.mixture(level).totalSupport(), map.mixture(0).totalSupport(), 1e-2);
        EXPECT_NO_THROW(map.mixture(level).check());
    }
    EXPECT_THROW(map.mixture(5), std::out_of_range);
}

}  // namespace
}  // namespace hgmm
