#include "hgmm/surface_likelihood.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace hgmm {
namespace {

Mixture<3> wallAndPost() {
    Mixture<3> mixture;
    Gaussian<3> wall;
    wall.support = 1000;
    wall.covariance.diagonal() << 0.0001, 1.0, 1.0;
    mixture.pushBack(wall);
    Gaussian<3> post;
    post.support = 10;
    post.mean << 1.0, 0.0, 0.0;
    post.covariance.diagonal() << 0.01, 0.01, 1.0;
    mixture.pushBack(post);
    return mixture;
}

TEST(SurfaceLikelihood, IsItsFormula) {
    const double softening = 0.1, outliers = 0.05;
    const Mixture<3> mixture = wallAndPost();
    const SurfaceLikelihood likelihood(mixture, softening, outliers);
    for (double x = -0.5; x < 1.5; x += 0.05) {
        const double wall = x * x / (0.0001 + 0.01),
                     post = (x - 1) * (x - 1) / (0.01 + 0.01);
        double squared = std::min(wall, post);
        // Components are left out beyond the index' reach, where they add less than the
        // floor.
        if (squared > 16) squared = 1e9;
        const double expected =
            std::log(outliers + (1 - outliers) * std::exp(-0.5 * squared));
        EXPECT_NEAR(likelihood(float(x), 0.F, 0.F), expected, 2e-2) << "x = " << x;
        EXPECT_NEAR(likelihood(float(x), 0.F, 0.F), expected,
                    std::abs(squared - 16) < 2 ? 2e-2 : 1e-3);
    }
}

TEST(SurfaceLikelihood, DoesNotDependOnSupportOrSizeOfTheMap) {
    const Mixture<3> mixture = wallAndPost();
    Mixture<3> larger = mixture;
    for (float& support : larger.support) support *= 50;
    for (int i = 0; i < 500; ++i) {
        Gaussian<3> far = mixture[1];
        far.mean << 100.0 + i, 0, 0;
        larger.pushBack(far);
    }
    const SurfaceLikelihood a(mixture, 0.1, 0.05), b(larger, 0.1, 0.05);
    for (float x = -1; x < 2; x += 0.1F) EXPECT_EQ(a(x, 0.2F, 0.F), b(x, 0.2F, 0.F));
}

TEST(SurfaceLikelihood, IsFiniteEverywhere) {
    const SurfaceLikelihood likelihood(wallAndPost(), 0.1, 0.05);
    const SurfaceLikelihood empty(Mixture<3>(), 0.1, 0.05);
    const float nan = std::numeric_limits<float>::quiet_NaN();
    for (const float v : {0.F, 1e6F, -3e38F, nan, std::numeric_limits<float>::infinity()}) {
        for (const SurfaceLikelihood* l : {&likelihood, &empty}) {
            EXPECT_GE((*l)(v, v, v), std::log(0.05) - 1e-12);
            EXPECT_LE((*l)(v, v, v), 0.0);
        }
    }
    EXPECT_NEAR(empty(0, 0, 0), std::log(0.05), 1e-12);
}

TEST(SurfaceLikelihood, RefusesBadParameters) {
    const Mixture<3> mixture = wallAndPost();
    EXPECT_THROW(SurfaceLikelihood(mixture, -0.1, 0.05), std::invalid_argument);
    EXPECT_THROW(SurfaceLikelihood(mixture, 0.1, 0.0), std::invalid_argument);
    EXPECT_THROW(SurfaceLikelihood(mixture, 0.1, 1.0), std::invalid_argument);
    EXPECT_THROW(SurfaceLikelihood(mixture, std::nan(""), 0.5), std::invalid_argument);
}

}  // namespace
}  // namespace hgmm
