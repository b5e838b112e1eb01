#include "hgmm/mixture.h"

#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <cmath>
#include <limits>
#include <random>

#include "hgmm/gaussian.h"

namespace hgmm {
namespace {

template <int D>
Gaussian<D> randomGaussian(std::mt19937_64& random) {
    std::uniform_real_distribution<double> uniform(-1.0, 1.0);
    Gaussian<D> g;
    g.support = 2.0 + uniform(random);
    Eigen::Matrix<double, D, D> A;
    for (int r = 0; r < D; ++r) {
        g.mean[r] = 5.0 * uniform(random);
        for (int c = 0; c < D; ++c) A(r, c) = uniform(random);
    }
    g.covariance = A * A.transpose() + 0.05 * Eigen::Matrix<double, D, D>::Identity();
    return g;
}

template <typename T>
class MixtureTest : public ::testing::Test {};
using Dimensions =
    ::testing::Types<std::integral_constant<int, 2>, std::integral_constant<int, 3>,
                     std::integral_constant<int, 4>>;
TYPED_TEST_SUITE(MixtureTest, Dimensions);

TYPED_TEST(MixtureTest, StoresWhatItIsGiven) {
    constexpr int D = TypeParam::value;
    std::mt19937_64 random(1);
    Mixture<D> mixture;
    std::vector<Gaussian<D>> components;
    for (int i = 0; i < 20; ++i) {
        components.push_back(randomGaussian<D>(random));
        mixture.pushBack(components.back());
    }
    mixture.check();
    for (int i = 0; i < 20; ++i) {
        const Gaussian<D> g = mixture[i];
        EXPECT_NEAR(g.support, components[i].support, 1e-6);
        EXPECT_TRUE(g.mean.isApprox(components[i].mean, 1e-6));
        EXPECT_TRUE(g.covariance.isApprox(components[i].covariance, 1e-6));
    }
}

TYPED_TEST(MixtureTest, PackedIndexCountsThroughTheUpperTriangle) {
    constexpr int D = TypeParam::value;
    int expected = 0;
    for (int row = 0; row < D; ++row)
        for (int col = row; col < D; ++col, ++expected) {
            EXPECT_EQ(packedIndex(D, row, col), expected);
            EXPECT_EQ(packedIndex(D, col, row), expected);
        }
    EXPECT_EQ(expected, packedSize(D));
}

TYPED_TEST(MixtureTest, WhitenedGaussianAgreesWithEigen) {
    constexpr int D = TypeParam::value;
    using Vector = Eigen::Matrix<double, D, 1>;
    using Matrix = Eigen::Matrix<double, D, D>;
    std::mt19937_64 random(2);
    for (int trial = 0; trial < 50; ++trial) {
        const Gaussian<D> g = randomGaussian<D>(random);
        const Vector x = randomGaussian<D>(random).mean;
        const Matrix C = randomGaussian<D>(random).covariance;
        const WhitenedGaussian<D> whitened(g);
        const Matrix covariance = g.covariance;
        const Eigen::LLT<Matrix> llt(covariance);
        const Vector d = x - Vector(g.mean);
        const double squared = d.dot(llt.solve(d));
        const double logDet = 2 * Matrix(llt.matrixL()).diagonal().array().log().sum();
        EXPECT_NEAR(whitened.squaredMahalanobis(x.data()), squared, 1e-9 * (1 + squared));
        EXPECT_NEAR(whitened.logDeterminant(), logDet, 1e-9);
        EXPECT_NEAR(whitened.logPdf(x.data()),
                    -0.5 * (D * std::log(2 * M_PI) + logDet + squared),
                    1e-8 * (1 + squared));
        EXPECT_NEAR(whitened.traceOfPrecisionTimes(C), llt.solve(C).trace(),
                    1e-8 * llt.solve(C).trace());
    }
}

TYPED_TEST(MixtureTest, AppendGivesTheWeightsOfEquation323) {
    constexpr int D = TypeParam::value;
    std::mt19937_64 random(3);
    Mixture<D> old, added;
    for (int i = 0; i < 4; ++i) old.pushBack(randomGaussian<D>(random));
    for (int i = 0; i < 3; ++i) added.pushBack(randomGaussian<D>(random));
    const double N = old.totalSupport(), N_added = added.totalSupport();
    Mixture<D> joined = old;
    joined.append(added);
    ASSERT_EQ(joined.size(), 7U);
    double sum = 0;
    for (std::size_t i = 0; i < joined.size(); ++i) {
        const double weight = joined.weight(i, joined.totalSupport());
        const double expected =
            i < 4 ? old.weight(i, N) * N / (N + N_added)
                  : added.weight(i - 4, N_added) * N_added / (N + N_added);
        EXPECT_NEAR(weight, expected, 1e-6);
        sum += weight;
    }
    EXPECT_NEAR(sum, 1.0, 1e-12);
}

TYPED_TEST(MixtureTest, MergedMomentsAreThoseOfTheUnion) {
    constexpr int D = TypeParam::value;
    using Matrix = Eigen::Matrix<double, D, D>;
    std::mt19937_64 random(4);
    const Gaussian<D> a = randomGaussian<D>(random), b = randomGaussian<D>(random);
    const Gaussian<D> m = mergeMoments(a, b);
    const auto second = [](const Gaussian<D>& g) -> Matrix {
        return g.support * (g.covariance + g.mean * g.mean.transpose());
    };
    EXPECT_NEAR(m.support, a.support + b.support, 1e-12);
    EXPECT_TRUE(
        (m.support * m.mean).isApprox(a.support * a.mean + b.support * b.mean, 1e-12));
    EXPECT_TRUE(second(m).isApprox(second(a) + second(b), 1e-12));
}

TEST(Mixture, RemoveSwapPutsTheLastInPlace) {
    std::mt19937_64 random(5);
    Mixture<3> mixture;
    for (int i = 0; i < 3; ++i) mixture.pushBack(randomGaussian<3>(random));
    const Gaussian<3> last = mixture[2], middle = mixture[1];
    mixture.removeSwap(0);
    ASSERT_EQ(mixture.size(), 2U);
    EXPECT_EQ(mixture[0].mean, last.mean);
    EXPECT_EQ(mixture[1].mean, middle.mean);
    EXPECT_THROW(mixture.removeSwap(2), std::out_of_range);
}

TEST(Mixture, CheckFindsWhatIsWrong) {
    std::mt19937_64 random(6);
    Mixture<3> good;
    good.pushBack(randomGaussian<3>(random));
    good.check();
    Mixture<3> bad = good;
    bad.mean[1][0] = std::numeric_limits<float>::quiet_NaN();
    EXPECT_THROW(bad.check(), std::logic_error);
    bad = good;
    bad.support[0] = 0;
    EXPECT_THROW(bad.check(), std::logic_error);
    bad = good;
    bad.covariance[packedIndex(3, 0, 1)][0] = 1e3F;
    EXPECT_THROW(bad.check(), std::logic_error);
    bad = good;
    bad.mean[2].push_back(0);
    EXPECT_THROW(bad.check(), std::logic_error);
}

TEST(Gaussian, SingularCovarianceStaysFinite) {
    Gaussian<3> flat;
    flat.support = 1;
    flat.covariance(0, 0) = 1.0;  // a line
    const WhitenedGaussian<3> whitened(flat);
    const double x[3] = {0.5, 0.5, 0.5};
    EXPECT_TRUE(std::isfinite(whitened.logPdf(x)));
    EXPECT_GT(whitened.squaredMahalanobis(x), 1e9);
}

TEST(Gaussian, LogAddExp) {
    EXPECT_NEAR(logAddExp(std::log(2.0), std::log(3.0)), std::log(5.0), 1e-12);
    EXPECT_NEAR(logAddExp(-2000.0, -2000.0), -2000.0 + std::log(2.0), 1e-9);
    const double zero = -std::numeric_limits<double>::infinity();
    EXPECT_EQ(logAddExp(zero, 1.5), 1.5);
    EXPECT_EQ(logAddExp(1.5, zero), 1.5);
    EXPECT_EQ(logAddExp(zero, zero), zero);
}

}  // namespace
}  // namespace hgmm
