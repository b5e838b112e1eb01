#include "mixture/knee.h"

#include <gtest/gtest.h>

#include <cmath>
#include <iostream>

#include "hgmm/hierarchy.h"
#include "overestimate.h"
#include "planted_mixture.h"

namespace hgmm::test {
namespace {

std::vector<DivergencePoint> curveOf(const std::vector<std::size_t>& sizes,
                                     double (*divergence)(double)) {
    std::vector<DivergencePoint> curve;
    for (const std::size_t size : sizes)
        curve.push_back({size, divergence(static_cast<double>(size)), 0});
    return curve;
}

const std::vector<std::size_t> kSizes{100, 90, 80, 70, 60, 50, 40, 30, 20, 10};

TEST(Knee, IsWhereAFlatCurveStartsToClimb) {
    const auto curve =
        curveOf(kSizes, [](double n) { return std::max(0.0, 40 - n) * 0.05; });
    EXPECT_EQ(curve[findKnee(curve)].size, 40u);
}

TEST(Knee, IsWhereASlopeSteepens) {
    const auto curve = curveOf(
        kSizes, [](double n) { return (100 - n) * 0.001 + std::max(0.0, 60 - n) * 0.03; });
    EXPECT_EQ(curve[findKnee(curve)].size, 60u);
}

TEST(Knee, DoesNotDependOnTheUnits) {
    const auto curve = curveOf(kSizes, [](double n) { return std::exp(-n / 15); });
    auto scaled = curve;
    for (DivergencePoint& point : scaled) {
        point.size *= 7;
        point.divergence = 1000 * point.divergence + 5;
    }
    EXPECT_EQ(findKnee(curve), findKnee(scaled));
}

TEST(Knee, CollapseOfTheLastComponentsDoesNotMatter) {
    auto curve = curveOf(kSizes, [](double n) { return std::max(0.0, 40 - n) * 0.05; });
    const std::size_t knee = findKnee(curve);
    curve.push_back({2, 1e3, 0});
    curve.push_back({1, 1e6, 0});
    EXPECT_EQ(findKnee(curve), knee);
}

TEST(Knee, WithoutKneeIsThePointOfLeastDivergence) {
    EXPECT_EQ(findKnee({}), 0u);
    EXPECT_EQ(findKnee({{5, 0, 0}}), 0u);
    EXPECT_EQ(findKnee({{5, 0, 0}, {4, 0.3, 0}}), 0u);
    EXPECT_EQ(findKnee({{5, 0, 0}, {1, -0.3, 0}}), 1u);
    EXPECT_EQ(findKnee({{5, 0, 0}, {4, 0, 0}, {3, 0, 0}}), 2u);
    EXPECT_EQ(findKnee(curveOf(kSizes, [](double n) { return 100 - n; })), 0u);  // straight
    EXPECT_EQ(findKnee(curveOf(kSizes, [](double n) { return std::sqrt(100 - n); })), 0u);
    EXPECT_EQ(findKnee(curveOf(kSizes, [](double n) { return n - 100; })), 9u);  // falls
    EXPECT_EQ(findKnee(curveOf(kSizes, [](double) { return 0.0; })), 9u);        // flat
}

/// Size that a threefold overestimate, fitted by EM, is reduced to.
std::size_t estimatedSize(std::size_t planted, std::uint64_t seed) {
    std::mt19937_64 engine(seed);
    Planting planting;
    planting.components = planted;
    const Mixture<3> truth = plantMixture<3>(planting, engine);
    const auto points = static_cast<std::size_t>(truth.totalSupport());
    const Mixture<3> samples = asSamples<3>(drawPoints(truth, points, seed), 0.01);
    const Overestimate<3> guess = overestimate(samples, 3 * planted, 8, engine);
    EmParams em;
    em.maxIterations = 15;
    em.minImprovement = 1e-4;
    const EmResult<3> fit = fitSparse(samples, guess.mixture, guess.neighbourhoods, em);
    HierarchyParams hierarchy;
    hierarchy.similarityMax = 1e6;  // the knee decides alone
    return generateHierarchy(fit.mixture, hierarchy).levels[0].size();
}

TEST(Knee, FindsTheSizeOfPlantedMixtures) {
    int close = 0;
    double ratio = 0;
    for (std::uint64_t seed = 1; seed <= 100; ++seed) {
        const std::size_t planted = 10 + (seed * 7) % 51;  // 10 .. 60
        const auto estimate = static_cast<double>(estimatedSize(planted, seed));
        const double relative = estimate / static_cast<double>(planted);
        close += std::abs(relative - 1) <= 0.2 + 1e-9;
        ratio += relative / 100;
    }
    std::cout << "knee: " << close << " of 100 within 20 %, estimate / planted " << ratio
              << " in the mean\n";
    RecordProperty("within_20_percent", close);
    RecordProperty("mean_ratio", std::to_string(ratio));
    EXPECT_GE(close, 90);
}

}  // namespace
}  // namespace hgmm::test
