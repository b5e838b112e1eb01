#include "modality/value_index.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

namespace hgmm {
namespace {

ChannelMixture scattered(std::size_t components) {
    std::mt19937_64 random(1);
    std::uniform_real_distribution<double> even(0.0, 1.0);
    ChannelMixture mixture(1);
    for (std::size_t i = 0; i < components; ++i) {
        ChannelGaussian g;
        g.place.support = 1 + 100 * even(random);
        g.place.covariance = 0.01 * Eigen::Matrix3d::Identity();
        g.fits[0].mean = even(random);
        g.fits[0].slope = {even(random), 0, even(random)};
        g.fits[0].residual = 1e-4 + 1e-3 * even(random);
        mixture.pushBack(g);
    }
    return mixture;
}

/// log of the numerator of thesis eq. (5.9).
double logWeight(const ChannelMixture& mixture, std::size_t k, double value) {
    const Gaussian<4> g = mixture[k].joint(0);
    const double d = value - g.mean[3];
    return std::log(g.support) -
           0.5 * (std::log(g.covariance(3, 3)) + d * d / g.covariance(3, 3));
}

TEST(ValueIndex, FindsTheHeaviestComponentsAtAValue) {
    const ChannelMixture mixture = scattered(2000);
    const ValueIndex index(mixture, 0);
    for (double value = 0.05; value < 1; value += 0.1) {
        std::vector<double> all;
        for (std::size_t k = 0; k < mixture.size(); ++k)
            all.push_back(logWeight(mixture, k, value));
        std::sort(all.rbegin(), all.rend());
        const auto found = index.at(value);
        ASSERT_EQ(found.last - found.first, std::ptrdiff_t(ValueIndex::kCandidates));
        // Sorted for the middle of an interval of values, so nearly so for the value.
        EXPECT_GT(logWeight(mixture, *found.first, value), all[0] - 0.2);
        for (const std::uint32_t k : found)
            EXPECT_GT(logWeight(mixture, k, value), all[ValueIndex::kCandidates] - 0.5);
    }
}

TEST(ValueIndex, DensitiesAreThoseOfTheMarginals) {
    const ChannelMixture mixture = scattered(20);
    const ValueIndex index(mixture, 0);
    for (std::uint32_t k = 0; k < 20; ++k)
        EXPECT_NEAR(
            index.logDensity(k, 0.4) + std::log(double(mixture.places().support[k])),
            logWeight(mixture, k, 0.4), 1e-6);
}

TEST(ValueIndex, ValuesOutOfRangeFindNothing) {
    const ValueIndex index(scattered(100), 0);
    for (const double value : {-10.0, 10.0, 1e300, double(NAN)}) {
        const auto found = index.at(value);
        EXPECT_EQ(found.first, found.last);
    }
    const ValueIndex empty(ChannelMixture(1), 0);
    EXPECT_EQ(empty.at(0.5).first, empty.at(0.5).last);
}

}  // namespace
}  // namespace hgmm
