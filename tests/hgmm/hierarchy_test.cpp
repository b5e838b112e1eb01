#include "hgmm/hierarchy.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <stdexcept>
#include <string>
#include <vector>

#include "hgmm/divergence.h"
#include "mixture/agglomeration.h"
#include "mixture/knee.h"
#include "planted_mixture.h"

namespace hgmm::test {
namespace {

/// Algorithm 1, lines 6-16, as written.
template <int D>
Mixture<D> bruteForceMerge(const Mixture<D>& mixture, double similarity) {
    std::vector<Gaussian<D>> parts;
    for (std::size_t i = 0; i < mixture.size(); ++i) parts.push_back(mixture[i]);
    std::vector<bool> absorbed(parts.size(), false);
    Mixture<D> merged;
    for (std::size_t i = 0; i < parts.size(); ++i) {
        if (absorbed[i]) continue;
        for (std::size_t j = i + 1; j < parts.size(); ++j) {
            if (absorbed[j]) continue;
            if (std::min(klDivergence(parts[i], parts[j]),
                         klDivergence(parts[j], parts[i])) >= similarity)
                continue;
            parts[i] = mergeMoments(parts[i], parts[j]);
            absorbed[j] = true;
        }
        merged.pushBack(parts[i]);
    }
    return merged;
}

/// Components crowded enough for chains of merges, and some far larger than the others.
template <int D>
Mixture<D> crowd(std::uint64_t seed, std::size_t size) {
    std::mt19937_64 engine(seed);
    Mixture<D> mixture;
    const double extent = 2 * std::pow(double(size), 1.0 / D);
    for (std::size_t i = 0; i < size; ++i) {
        Gaussian<D> g;
        g.support = uniform(engine, 1, 20);
        for (int a = 0; a < D; ++a)
            g.mean[a] = uniform(engine, 0, a == 0 ? 2 * extent : extent);
        g.covariance = randomCovariance<D>(engine, 5) * (engine() % 20 == 0 ? 30 : 1);
        mixture.pushBack(g);
    }
    return mixture;
}

template <int D>
Mixture<D> afterPass(const Mixture<D>& mixture, double similarity) {
    Agglomeration<D> levels(mixture);
    levels.pass(similarity);
    return levels.mixture();
}

template <int D>
void expectPassIsBruteForce() {
    for (std::uint64_t seed = 1; seed <= 6; ++seed)
        for (const double similarity : {0.3, 0.9, 3.0, 20.0}) {
            const Mixture<D> mixture = crowd<D>(seed, 200);
            const Mixture<D> merged = afterPass(mixture, similarity);
            EXPECT_TRUE(merged == bruteForceMerge(mixture, similarity))
                << "D " << D << " seed " << seed << " similarity " << similarity;
            if (similarity >= 3) {
                EXPECT_LT(merged.size(), mixture.size());
            }
        }
}

TEST(MergePass, EqualsTheDoubleLoop) {
    expectPassIsBruteForce<2>();
    expectPassIsBruteForce<3>();
    expectPassIsBruteForce<4>();
    const Mixture<3> mixture = crowd<3>(1, 200);
    EXPECT_TRUE(mergePass(mixture, 0.9) == bruteForceMerge(mixture, 0.9));
}

/// Whether rows tell which component holds each of the first mixture, by its mean.
template <int D>
void expectParentsHold(const Agglomeration<D>& levels, const Mixture<D>& first) {
    const Mixture<D> left = levels.mixture();
    const std::vector<std::uint32_t> parents = levels.parents();
    std::vector<double> support(left.size(), 0.0);
    for (std::size_t i = 0; i < first.size(); ++i) support[parents[i]] += first.support[i];
    for (std::size_t k = 0; k < left.size(); ++k)
        EXPECT_NEAR(support[k] / left.support[k], 1.0, 1e-5);
}

template <int D>
void expectPassesAreBruteForce() {
    for (std::uint64_t seed = 1; seed <= 4; ++seed) {
        const Mixture<D> mixture = crowd<D>(seed, 200);
        Mixture<D> expected = mixture;
        Agglomeration<D> levels(mixture);
        for (double similarity = 0.1; similarity < 400; similarity *= 1.3) {
            const Mixture<D> before = expected;
            expected = bruteForceMerge(expected, similarity);
            EXPECT_EQ(levels.pass(similarity), expected.size() < before.size());
            ASSERT_TRUE(levels.mixture() == expected)
                << "D " << D << " seed " << seed << " similarity " << similarity;
            expectParentsHold(levels, mixture);
        }
        EXPECT_LT(levels.size(), mixture.size() / 4);
    }
}

TEST(Agglomeration, EqualsTheDoubleLoopPassAfterPass) {
    expectPassesAreBruteForce<2>();
    expectPassesAreBruteForce<3>();
    expectPassesAreBruteForce<4>();
}

TEST(MergePass, KeepsWeightMeanAndSecondMoments) {
    const auto momentsOf = [](const Mixture<3>& mixture) {
        Gaussian<3> sum = mixture[0];
        for (std::size_t i = 1; i < mixture.size(); ++i)
            sum = mergeMoments(sum, mixture[i]);
        return sum;
    };
    for (std::uint64_t seed = 1; seed <= 5; ++seed) {
        const Mixture<3> mixture = crowd<3>(seed, 300);
        const Gaussian<3> before = momentsOf(mixture);
        for (const double similarity : {1.0, 5.0, 1e6}) {
            const Mixture<3> merged = mergePass(mixture, similarity);
            EXPECT_LT(merged.size(), mixture.size());
            const Gaussian<3> after = momentsOf(merged);
            EXPECT_NEAR(after.support / before.support, 1, 1e-5);
            EXPECT_LT((after.mean - before.mean).norm(), 1e-5 * before.mean.norm());
            EXPECT_LT((after.covariance - before.covariance).norm(),
                      1e-5 * before.covariance.norm());
            EXPECT_NO_THROW(merged.check());
        }
    }
}

TEST(MergePass, UsesTheSmallerDivergence) {
    // A small component inside a large one: KL(small || large) = 2.9, KL(large || small)
    // = 42.
    Mixture<3> mixture;
    mixture.pushBack({1, {0, 0, 0}, Gaussian<3>::Matrix::Identity()});
    mixture.pushBack({1, {0, 0, 0}, 0.03 * Gaussian<3>::Matrix::Identity()});
    ASSERT_GT(klDivergence(mixture[0], mixture[1]), 40);
    const double smaller = klDivergence(mixture[1], mixture[0]);
    EXPECT_EQ(mergePass(mixture, smaller * 1.001).size(), 1u);
    EXPECT_EQ(mergePass(mixture, smaller * 0.999).size(), 2u);
    Mixture<3> swapped;
    swapped.pushBack(mixture[1]);
    swapped.pushBack(mixture[0]);
    EXPECT_EQ(mergePass(swapped, smaller * 1.001).size(), 1u);
}

TEST(MergePass, OfLittle) {
    EXPECT_TRUE(mergePass(Mixture<3>{}, 1).empty());
    const Mixture<3> one = crowd<3>(1, 1);
    EXPECT_TRUE(mergePass(one, 1) == one);
}

template <int D>
void expectConsistent(const Mixture<D>& reference, const Hierarchy<D>& h, int levels) {
    ASSERT_FALSE(h.levels.empty());
    ASSERT_LE(h.levels.size(), static_cast<std::size_t>(levels));
    ASSERT_LT(h.knee, h.curve.size());
    EXPECT_EQ(h.curve[0].size, reference.size());
    EXPECT_EQ(h.curve[0].divergence, 0);
    for (std::size_t l = 0; l < h.levels.size(); ++l) {
        const DivergencePoint& point = h.curve[h.knee + l];
        EXPECT_EQ(h.levels[l].size(), point.size);
        if constexpr (D == 3) {
            if (h.knee + l == 0) continue;
            // Supports are floats: the total of a level differs by some 1e-8 from the last.
            EXPECT_NEAR(klDivergence(reference, h.levels[l]), point.divergence, 1e-6);
        }
        EXPECT_NEAR(h.levels[l].totalSupport() / reference.totalSupport(), 1, 1e-5);
        EXPECT_NO_THROW(h.levels[l].check());
    }
    for (std::size_t k = 1; k < h.curve.size(); ++k) {
        EXPECT_LT(h.curve[k].size, h.curve[k - 1].size);
        EXPECT_GT(h.curve[k].similarity, h.curve[k - 1].similarity);
    }
}

TEST(Hierarchy, LevelsLieOnTheCurve) {
    for (std::uint64_t seed = 1; seed <= 5; ++seed) {
        const Mixture<3> reference = crowd<3>(seed, 200);
        HierarchyParams uncapped;
        uncapped.similarityMax = 1e6;
        const Hierarchy<3> h = generateHierarchy(reference, uncapped);
        expectConsistent(reference, h, 5);
        EXPECT_EQ(h.levels.size(), 5u);
        EXPECT_EQ(h.knee, findKnee(h.curve));
    }
    expectConsistent(crowd<2>(1, 100), generateHierarchy(crowd<2>(1, 100), {}), 5);
}

TEST(Hierarchy, FidelityThresholdNeedsNoMoreThanSimilarityMax) {
    for (std::uint64_t seed = 1; seed <= 5; ++seed) {
        const Mixture<3> reference = crowd<3>(seed, 200);
        HierarchyParams params;
        params.similarityMax = 1.6;
        const Hierarchy<3> h = generateHierarchy(reference, params);
        expectConsistent(reference, h, 5);
        EXPECT_LE(h.curve[h.knee].similarity, params.similarityMax);
        // The cap, not the knee, decided: the next pass needs more.
        ASSERT_LT(h.knee, findKnee(h.curve));
        EXPECT_GT(h.curve[h.knee + 1].similarity, params.similarityMax);
    }
}

TEST(Hierarchy, FollowsTheSchedule) {
    // By hand: passes at 0.9, 1.1, ..., a level for each that merges.
    const Mixture<3> reference = crowd<3>(3, 150);
    HierarchyParams params;
    params.levels = 1000;
    const Hierarchy<3> h = generateHierarchy(reference, params);
    Mixture<3> mixture = reference;
    std::size_t level = 0;
    for (double similarity = 0.9; similarity < 4; similarity += 0.2) {
        const Mixture<3> merged = mergePass(mixture, similarity);
        if (merged.size() == mixture.size()) continue;
        mixture = merged;
        ++level;
        ASSERT_LT(level, h.curve.size());
        EXPECT_NEAR(h.curve[level].similarity, similarity, 1e-9);
        EXPECT_EQ(h.curve[level].size, mixture.size());
        if (level >= h.knee) {
            EXPECT_TRUE(h.levels[level - h.knee] == mixture);
        }
    }
    EXPECT_GT(level, 5u);
    EXPECT_EQ(h.levels.back().size(), 1u);
}

TEST(Hierarchy, WithoutStepEndsWhenNothingMerges) {
    HierarchyParams params;
    params.levels = 1000;
    params.similarityStep = 0;
    const Mixture<3> reference = crowd<3>(4, 100);
    const Hierarchy<3> h = generateHierarchy(reference, params);
    for (std::size_t k = 1; k < h.curve.size(); ++k) EXPECT_EQ(h.curve[k].similarity, 0.9);
    EXPECT_EQ(mergePass(h.levels.back(), 0.9).size(), h.levels.back().size());
}

TEST(Hierarchy, OfHostileMixtures) {
    const Hierarchy<3> none = generateHierarchy(Mixture<3>{}, {});
    ASSERT_EQ(none.levels.size(), 1u);
    EXPECT_TRUE(none.levels[0].empty());

    const Mixture<3> one = crowd<3>(1, 1);
    EXPECT_TRUE(generateHierarchy(one, {}).levels[0] == one);
    expectConsistent(crowd<3>(1, 2), generateHierarchy(crowd<3>(1, 2), {}), 5);

    Mixture<3> same, apart, flat;
    for (int i = 0; i < 50; ++i) {
        same.pushBack(one[0]);
        Gaussian<3> g = one[0];
        g.mean[0] += 1e7 * i;
        apart.pushBack(g);
        g.mean = {0.1 * i, 0, 0};
        g.covariance = Gaussian<3>::Vector(0.01, 0.01, 1e-9).asDiagonal();
        flat.pushBack(g);
    }
    EXPECT_EQ(generateHierarchy(same, {}).levels[0].size(), 1u);
    EXPECT_EQ(generateHierarchy(apart, {}).levels[0].size(), 50u);
    const Hierarchy<3> flatLevels = generateHierarchy(flat, {});
    expectConsistent(flat, flatLevels, 5);
    for (const DivergencePoint& point : flatLevels.curve)
        EXPECT_TRUE(std::isfinite(point.divergence));
}

void expectNames(const HierarchyParams& params, const std::string& field) {
    try {
        params.validate();
        FAIL() << "accepted a wrong " << field;
    } catch (const std::invalid_argument& e) {
        EXPECT_NE(std::string(e.what()).find(field), std::string::npos) << e.what();
    }
    EXPECT_THROW(generateHierarchy(Mixture<2>{}, params), std::invalid_argument);
}

TEST(Hierarchy, WrongParamsAreNamed) {
    EXPECT_NO_THROW(HierarchyParams{}.validate());
    HierarchyParams params;
    params.levels = 0;
    expectNames(params, "levels");
    for (const double wrong :
         {-1.0, std::nan(""), std::numeric_limits<double>::infinity()}) {
        params = {};
        params.similarityStart = wrong;
        expectNames(params, "similarityStart");
        params = {};
        params.similarityStep = wrong;
        expectNames(params, "similarityStep");
    }
    params = {};
    params.similarityStart = 0;
    expectNames(params, "similarityStart");
}

}  // namespace
}  // namespace hgmm::test
