#include "map/levels.h"

#include <gtest/gtest.h>

#include <random>

namespace hgmm {
namespace {

Gaussian<3> patchAt(std::mt19937_64& random, double x0) {
    std::uniform_real_distribution<double> uniform(-1.0, 1.0);
    Gaussian<3> g;
    g.support = 5 + 4 * uniform(random);
    g.mean << x0 + 4 * uniform(random), 4 * uniform(random), 0.05 * uniform(random);
    const double size = 0.02 + 0.15 * std::abs(uniform(random));  // variances: they overlap
    g.covariance.diagonal() << size, size, 1e-4;
    return g;
}

Mixture<3> floorPatches(std::mt19937_64& random) {
    Mixture<3> base;
    for (int i = 0; i < 2000; ++i) base.pushBack(patchAt(random, i < 1000 ? 0.0 : 100.0));
    return base;  // two floors of more than one block each
}

LevelBlocks blocksOf(const Mixture<3>& base) {
    LevelBlocks blocks;
    Changes all{base.size(), {}};
    for (std::uint32_t i = 0; i < base.size(); ++i) all.updated.push_back(i);
    blocks.apply(all);
    return blocks;
}

TEST(LevelBlocks, KeepSupportMeanAndSecondMomentsOnEveryLevel) {
    std::mt19937_64 random(1);
    const Mixture<3> base = floorPatches(random);
    LevelBlocks blocks = blocksOf(base);
    HierarchyParams params;
    const auto moments = [](const Mixture<3>& m) {
        Gaussian<3> all = m[0];
        for (std::size_t i = 1; i < m.size(); ++i) all = mergeMoments(all, m[i]);
        return all;
    };
    const Gaussian<3> expected = moments(base);
    const auto& levels = blocks.levels(base, params);
    ASSERT_EQ(levels.size(), std::size_t(params.levels - 1));
    std::size_t size = base.size();
    for (const Mixture<3>& level : levels) {
        level.check();
        // Each block rounds down, so the ratio holds for the whole.
        EXPECT_LE(double(level.size()), params.levelRatio * double(size));
        size = level.size();
        const Gaussian<3> all = moments(level);
        EXPECT_NEAR(all.support, expected.support, 1e-5 * expected.support);
        EXPECT_TRUE(all.mean.isApprox(expected.mean, 1e-5));
        EXPECT_TRUE(all.covariance.isApprox(expected.covariance, 1e-5));
    }
}

TEST(LevelBlocks, LocalRegenerationEqualsGeneratingAll) {
    std::mt19937_64 random(2);
    Mixture<3> base = floorPatches(random);
    LevelBlocks blocks = blocksOf(base);
    const HierarchyParams params;
    blocks.levels(base, params);
    const std::size_t all = blocks.lastRegenerated();
    Changes changes;
    for (int change = 0; change < 10; ++change) {
        const auto i = std::uint32_t(random() % 1000);  // in the first floor only
        base.set(i, patchAt(random, 0.0));
        changes.updated.push_back(i);
    }
    base.pushBack(patchAt(random, 0.0));
    changes.updated.push_back(std::uint32_t(base.size() - 1));
    changes.size = base.size();
    blocks.apply(changes);
    const std::vector<Mixture<3>> local = blocks.levels(base, params);
    EXPECT_LT(blocks.lastRegenerated(), all);
    EXPECT_GT(blocks.lastRegenerated(), 0U);
    LevelBlocks fresh = blocksOf(base);
    EXPECT_EQ(local, fresh.levels(base, params));
}

}  // namespace
}  // namespace hgmm
