#include "fusion/update.h"

#include <gtest/gtest.h>

#include <random>

#include "fusion/oversized.h"
#include "hgmm/gaussian.h"

namespace hgmm {
namespace {

struct Fixture {
    Mixture<3> mixture, samples;
    ComponentIndex index;
    NoveltySplit split;

    Fixture() {
        std::mt19937_64 random(1);
        std::normal_distribution<double> normal;
        Gaussian<3> c;
        c.support = 100;
        c.covariance.diagonal() << 1.0, 0.5, 0.1;
        mixture.pushBack(c);
        c.support = 40;
        c.mean << 1.5, 0.0, 0.0;
        mixture.pushBack(c);
        index.rebuild(mixture);
        for (int i = 0; i < 200; ++i) {
            Gaussian<3> s;
            s.support = 1 + i % 3;
            s.mean << 1.5 * normal(random), 0.5 * normal(random), 0.2 * normal(random);
            s.covariance = 0.01 * Eigen::Matrix3d::Identity();
            samples.pushBack(s);
        }
        split = splitByNovelty(samples, index, {});
    }
};

void lower(const std::vector<SupportDecay>& decays, Mixture<3>& mixture) {
    for (const SupportDecay& decay : decays)
        mixture.support[decay.component] = decay.support;
}

TEST(Update, IsEquations319To322) {
    Fixture f;
    const Mixture<3> old = f.mixture;
    // Direct evaluation with raw moments, as the thesis writes them.
    double S[2];
    Eigen::Vector3d S_mu[2];
    Eigen::Matrix3d S_Sigma[2];
    for (int j = 0; j < 2; ++j) {
        const Gaussian<3> g = old[j];
        S[j] = g.support;
        S_mu[j] = S[j] * g.mean;
        S_Sigma[j] = S[j] * (g.covariance + g.mean * g.mean.transpose());
    }
    double added = 0;
    for (std::size_t k = 0; k < f.split.known.size(); ++k) {
        const Gaussian<3> z = f.samples[f.split.known[k]];
        const auto& n = f.split.neighbourhoods;
        double p[2] = {0, 0};
        for (std::uint32_t m = n.begin[k]; m < n.begin[k + 1]; ++m) {
            const std::uint32_t j = n.component[m];
            p[j] = old.weight(j, old.totalSupport()) *
                   std::exp(WhitenedGaussian<3>(old[j]).logPdf(z.mean.data()));
        }
        const double sum = p[0] + p[1];
        added += z.support;
        for (int j = 0; j < 2; ++j) {
            const double share = z.support * p[j] / sum;
            S[j] += share;
            S_mu[j] += share * z.mean;
            S_Sigma[j] += share * (z.covariance + z.mean * z.mean.transpose());
        }
    }
    const KnownUpdate update = updateKnown(f.mixture, f.index, f.samples, f.split);
    ASSERT_EQ(update.changed, (std::vector<std::uint32_t>{0, 1}));
    ASSERT_EQ(update.components.size(), 2U);
    for (const std::uint32_t j : update.changed) f.mixture.set(j, update.components[j]);
    f.mixture.check();
    for (int j = 0; j < 2; ++j) {
        const Gaussian<3> g = f.mixture[j];
        const Eigen::Vector3d mu = S_mu[j] / S[j];
        EXPECT_NEAR(g.support, S[j], 1e-3);
        EXPECT_TRUE(g.mean.isApprox(mu, 1e-5));
        EXPECT_TRUE(g.covariance.isApprox(S_Sigma[j] / S[j] - mu * mu.transpose(), 1e-4));
        // eq. (3.20): weights are supports over N + N'.
        EXPECT_NEAR(f.mixture.weight(j, f.mixture.totalSupport()), S[j] / (140 + added),
                    1e-5);
    }
}

TEST(Update, NothingKnownChangesNothing) {
    Fixture f;
    NoveltySplit none;
    none.neighbourhoods.begin.push_back(0);
    EXPECT_TRUE(updateKnown(f.mixture, f.index, f.samples, none).changed.empty());
}

TEST(Oversized, ComponentsLoseTheSupportOfSamplesThatTheyCannotExplain) {
    Fixture f;
    NoveltySplit split;  // sample 1 has support 2, sample 2 has 3
    split.novel = {1, 2};
    split.oversized = {{1, 1}, {1, 2}};
    const std::vector<SupportDecay> decays =
        downweightOversized(f.mixture, f.index, f.samples, split);
    ASSERT_EQ(decays.size(), 1U);
    EXPECT_EQ(decays[0].component, 1U);
    EXPECT_EQ(decays[0].support, 35.F) << "of 40";
    lower(decays, f.mixture);
    // Supports stay positive.
    f.samples.support[2] = 50.F;
    split.oversized = {{1, 2}};
    lower(downweightOversized(f.mixture, f.index, f.samples, split), f.mixture);
    EXPECT_EQ(f.mixture.support[1], kNoSupport);
    EXPECT_TRUE(downweightOversized(f.mixture, f.index, f.samples, split).empty())
        << "nothing is left";
}

TEST(Oversized, ComponentsLoseWhatTheyWouldBeGiven) {
    // Of each sample, component 0 explains what component 1, oversized, does not claim.
    Fixture f;
    const Mixture<3> old = f.mixture;
    NoveltySplit split;
    split.neighbourhoods.begin.push_back(0);
    double expected = 0;
    for (std::uint32_t i = 0; i < f.samples.size(); ++i) {
        split.oversized.push_back({1, i});
        if (i % 2 == 0) {
            split.novel.push_back(i);
            expected += f.samples.support[i];
            continue;
        }
        split.known.push_back(i);
        split.neighbourhoods.component.push_back(0);
        split.neighbourhoods.begin.push_back(split.neighbourhoods.begin.back() + 1);
        const Gaussian<3> z = f.samples[i];
        double p[2];
        for (int j = 0; j < 2; ++j)
            p[j] = old.support[j] *
                   std::exp(WhitenedGaussian<3>(old[j]).logPdf(z.mean.data()));
        expected += f.samples.support[i] * p[1] / (p[0] + p[1]);
    }
    double all = 0;
    for (const float support : f.samples.support) all += support;
    ASSERT_LT(expected, 0.9 * all) << "component 0 has a part in them";
    for (float& support : f.samples.support) support *= 0.05F;  // less than there is
    const std::vector<SupportDecay> decays =
        downweightOversized(f.mixture, f.index, f.samples, split);
    ASSERT_EQ(decays.size(), 1U);
    EXPECT_EQ(decays[0].component, 1U);
    EXPECT_NEAR(decays[0].support, 40 - 0.05 * expected, 1e-3);
}

}  // namespace
}  // namespace hgmm
