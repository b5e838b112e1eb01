#include "index/component_index.h"

#include <gtest/gtest.h>

#include <limits>
#include <random>
#include <set>

namespace hgmm {
namespace {

/// Components of all sizes from millimetres to tens of metres.
Gaussian<3> randomComponent(std::mt19937_64& random) {
    std::uniform_real_distribution<double> uniform(-1.0, 1.0);
    Gaussian<3> g;
    g.support = 10;
    for (int d = 0; d < 3; ++d) g.mean[d] = 20 * uniform(random);
    Eigen::Matrix3d A;
    for (int k = 0; k < 9; ++k) A(k / 3, k % 3) = uniform(random);
    const double scale = std::pow(10.0, 1.5 * uniform(random) - 1.0);
    g.covariance =
        scale * scale * (A * A.transpose() + 0.001 * Eigen::Matrix3d::Identity());
    return g;
}

/// Every component within the index's sigmas must be visited, and each only once.
void expectComplete(const ComponentIndex& index, const Mixture<3>& mixture,
                    std::mt19937_64& random) {
    std::uniform_real_distribution<float> uniform(-25.F, 25.F);
    std::size_t hits = 0;
    for (int q = 0; q < 3000; ++q) {
        float p[3] = {uniform(random), uniform(random), uniform(random)};
        if (q % 2 == 0) {  // near a component, where there is something to find
            const std::size_t i = random() % mixture.size();
            for (int d = 0; d < 3; ++d) p[d] = mixture.mean[d][i] + 0.01F * uniform(random);
        }
        std::multiset<std::uint32_t> visited;
        index.visitCandidates(p[0], p[1], p[2],
                              [&](std::uint32_t i) { visited.insert(i); });
        for (std::uint32_t i = 0; i < mixture.size(); ++i) {
            EXPECT_LE(visited.count(i), 1U);
            const WhitenedGaussian<3, float> g(mixture[i]);
            if (g.squaredMahalanobis(p) >
                0.999F * ComponentIndex::kSigmas * ComponentIndex::kSigmas)
                continue;
            ++hits;
            EXPECT_EQ(visited.count(i), 1U) << "component " << i << " is missing";
        }
    }
    EXPECT_GT(hits, 1000U);
}

TEST(ComponentIndex, FindsWhatAScanOverAllComponentsFinds) {
    std::mt19937_64 random(1);
    Mixture<3> mixture;
    for (int i = 0; i < 300; ++i) mixture.pushBack(randomComponent(random));
    ComponentIndex index;
    index.rebuild(mixture);
    ASSERT_EQ(index.size(), mixture.size());
    expectComplete(index, mixture, random);
}

TEST(ComponentIndex, FollowsChangesAndRemovals) {
    std::mt19937_64 random(2);
    Mixture<3> mixture;
    ComponentIndex index;
    for (int step = 0; step < 1500; ++step) {
        const unsigned action = unsigned(random() % 4);
        if (action < 2 || mixture.size() < 50) {
            mixture.pushBack(randomComponent(random));
            index.update(mixture, std::uint32_t(mixture.size() - 1));
        } else {
            const auto i = std::uint32_t(random() % mixture.size());
            if (action == 2) {
                mixture.set(i, randomComponent(random));
                index.update(mixture, i);
            } else {
                mixture.removeSwap(i);
                index.truncate(mixture.size());
                if (i < mixture.size()) index.update(mixture, i);
            }
        }
    }
    ASSERT_EQ(index.size(), mixture.size());
    expectComplete(index, mixture, random);
}

TEST(ComponentIndex, InflationWidensEveryComponent) {
    Gaussian<3> g;
    g.support = 1;
    g.covariance = 1e-6 * Eigen::Matrix3d::Identity();
    Mixture<3> mixture;
    mixture.pushBack(g);
    ComponentIndex index(ComponentIndex::kSigmas, 0.5F);
    index.rebuild(mixture);
    const float p[3] = {0.5F, 0.F, 0.F};
    int visits = 0;
    index.visitCandidates(p[0], p[1], p[2], [&](std::uint32_t i) {
        ++visits;
        EXPECT_NEAR(index.factor(i).squaredMahalanobis(p), 1.F, 1e-3F);
    });
    EXPECT_EQ(visits, 1);
}

TEST(ComponentIndex, HostileQueriesFindNothing) {
    std::mt19937_64 random(3);
    Mixture<3> mixture;
    for (int i = 0; i < 20; ++i) mixture.pushBack(randomComponent(random));
    ComponentIndex index;
    index.rebuild(mixture);
    const float nan = std::numeric_limits<float>::quiet_NaN();
    const float inf = std::numeric_limits<float>::infinity();
    for (const float bad : {nan, inf, -inf, 3e38F})
        index.visitCandidates(bad, bad, 0.F, [](std::uint32_t) { ADD_FAILURE(); });
    EXPECT_THROW(index.update(mixture, 30), std::out_of_range);
}

TEST(ComponentIndex, CandidatesDoNotGrowWithTheMap) {
    // A corridor of equal components: the count of candidates per query stays what it was.
    const auto candidatesPerQuery = [](int length) {
        Mixture<3> mixture;
        Gaussian<3> g;
        g.support = 1;
        g.covariance = 0.01 * Eigen::Matrix3d::Identity();
        for (int i = 0; i < length; ++i) {
            g.mean << 0.3 * i, 0, 0;
            mixture.pushBack(g);
        }
        ComponentIndex index;
        index.rebuild(mixture);
        std::size_t candidates = 0;
        for (int q = 0; q < 100; ++q)
            index.visitCandidates(0.3F * float(length) * 0.5F + 0.01F * float(q), 0.F, 0.F,
                                  [&](std::uint32_t) { ++candidates; });
        return double(candidates) / 100;
    };
    EXPECT_NEAR(candidatesPerQuery(10000), candidatesPerQuery(100), 1.0);
    EXPECT_LT(candidatesPerQuery(10000), 10.0);
}

}  // namespace
}  // namespace hgmm
