#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>
#include <random>

#include "hgmm/regression.h"
#include "joint_mixture.h"

namespace {

using namespace hgmm;

/// A component over place and distance in closed form: w is 0 with probability 1 - f and
/// uniform in (0, b) with probability f; x = s + w u with s ~ N(mu, S).
struct Band {
    Eigen::Vector3d mu{0.3, -0.8, 1.1};
    Eigen::Matrix3d S;
    Eigen::Vector3d u = Eigen::Vector3d(1, 2, -2) / 3;
    double f = 0.75, b = 0.4;

    Band() { S << 0.04, 0.01, 0, 0.01, 0.09, -0.02, 0, -0.02, 0.02; }
    double meanW() const { return f * b / 2; }
    double varianceW() const { return f * b * b / 3 - meanW() * meanW(); }

    Gaussian<4> component() const {
        Gaussian<4> g;
        g.support = 10;
        g.mean << mu + meanW() * u, meanW();
        g.covariance.topLeftCorner<3, 3>() = S + varianceW() * u * u.transpose();
        g.covariance.topRightCorner<3, 1>() = varianceW() * u;
        g.covariance.bottomLeftCorner<1, 3>() = varianceW() * u.transpose();
        g.covariance(3, 3) = varianceW();
        return g;
    }
};

}  // namespace

TEST(SpatialModel, RecoversTheSurfaceOfABandExactly) {
    const Band band;
    Mixture<4> mixture;
    mixture.pushBack(band.component());
    const Mixture<3> surface = spatialModel(mixture);
    ASSERT_EQ(surface.size(), 1U);
    const Gaussian<3> g = surface[0];
    EXPECT_LT((g.mean - band.mu).norm(), 1e-6);
    EXPECT_LT((g.covariance - band.S).norm(), 1e-7);
    EXPECT_NEAR(g.support, 10, 1e-5);
    surface.check();
}

TEST(SpatialModel, BandHasTheMomentsOfItsSamples) {
    // The closed form of the fixture itself, by drawing what it says.
    const Band band;
    std::mt19937_64 engine(51);
    const Eigen::Matrix3d root = Eigen::LLT<Eigen::Matrix3d>(band.S).matrixL();
    Eigen::Vector4d sum = Eigen::Vector4d::Zero();
    Eigen::Matrix4d outer = Eigen::Matrix4d::Zero();
    constexpr int kDraws = 400000;
    for (int i = 0; i < kDraws; ++i) {
        const bool free = test::uniform(engine, 0, 1) < band.f;
        const double w = free ? test::uniform(engine, 0, band.b) : 0;
        const Eigen::Vector3d noise(test::normal(engine), test::normal(engine),
                                    test::normal(engine));
        Eigen::Vector4d p;
        p << band.mu + root * noise + w * band.u, w;
        sum += p;
        outer += p * p.transpose();
    }
    const Eigen::Vector4d mean = sum / kDraws;
    const Gaussian<4> g = band.component();
    EXPECT_LT((mean - g.mean).norm(), 3e-3);
    EXPECT_LT((outer / kDraws - mean * mean.transpose() - g.covariance).norm(), 2e-3);
}

TEST(SpatialModel, WeightsFollowTheDensityAtZero) {
    Mixture<4> mixture;
    Gaussian<4> g;
    g.covariance.setIdentity();
    g.support = 2;
    mixture.pushBack(g);
    g.support = 6;
    g.mean[3] = 2;
    mixture.pushBack(g);
    g.mean[3] = 100;  // nothing of it is at W = 0
    mixture.pushBack(g);
    const Mixture<3> surface = spatialModel(mixture);
    ASSERT_EQ(surface.size(), 2U);
    const double second = 6 * std::exp(-2.0);
    EXPECT_NEAR(surface.totalSupport(), 14, 1e-5);
    EXPECT_NEAR(surface.support[0], 14 * 2 / (2 + second), 1e-5);
    EXPECT_NEAR(surface.support[1], 14 * second / (2 + second), 1e-5);
}

TEST(SpatialModel, IsTheSliceOfTheJointDensity) {
    const Mixture<4> mixture = test::randomMixture<4>(5, 61);
    const Mixture<3> surface = spatialModel(mixture);
    std::mt19937_64 engine(62);
    double reference = 0;
    for (int i = 0; i < 20; ++i) {
        double x[3];
        for (double& v : x) v = test::uniform(engine, -1.5, 1.5);
        // p(x | w = 0) and p(x, w = 0) differ by a constant factor.
        const double difference = logDensity(surface, x) - test::logJoint(mixture, x, 0);
        if (i == 0) reference = difference;
        EXPECT_NEAR(difference, reference, 1e-4);
    }
}

TEST(SpatialModel, EmptyAndDegenerate) {
    EXPECT_TRUE(spatialModel(Mixture<4>{}).empty());
    Mixture<4> mixture;
    Gaussian<4> flat;  // without free points: W is always zero
    flat.support = 5;
    flat.covariance.topLeftCorner<3, 3>().setIdentity();
    mixture.pushBack(flat);
    const Mixture<3> surface = spatialModel(mixture);
    ASSERT_EQ(surface.size(), 1U);
    EXPECT_TRUE(surface[0].covariance.isApprox(Eigen::Matrix3d::Identity(), 1e-6));
    EXPECT_NEAR(surface[0].support, 5, 1e-6);
}
