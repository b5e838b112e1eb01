#include "hgmm/evaluation/gp_regression.h"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>
#include <limits>
#include <random>
#include <vector>

namespace {

using namespace hgmm::evaluation;

struct Data {
    std::vector<double> x, y;
};

/// Noisy sine, thesis eq. (4.19).
Data noisySine(std::size_t n, std::uint64_t seed) {
    std::mt19937_64 engine(seed);
    const auto uniform = [&] { return (double(engine() >> 11) + 0.5) * 0x1p-53; };
    Data data;
    for (std::size_t i = 0; i < n; ++i) {
        data.x.push_back(-2 + 4 * uniform());
        const double normal =
            std::sqrt(-2 * std::log(uniform())) * std::cos(2 * M_PI * uniform());
        data.y.push_back(std::sin(3 * data.x.back()) + 0.05 * normal);
    }
    return data;
}

GpRegression regressionOf(const Data& data) {
    GpRegression gp(-2, 2);
    for (std::size_t i = 0; i < data.x.size(); ++i) gp.add(data.x[i], data.y[i]);
    return gp;
}

/// The textbook solution, cubic in the number of data.
struct DenseGp {
    const Data& data;
    GpHyperparameters h;
    Eigen::LLT<Eigen::MatrixXd> factor;
    Eigen::VectorXd y, alpha;

    DenseGp(const Data& d, const GpHyperparameters& hyper) : data(d), h(hyper) {
        const auto n = static_cast<Eigen::Index>(d.x.size());
        Eigen::MatrixXd K(n, n);
        for (Eigen::Index i = 0; i < n; ++i)
            for (Eigen::Index j = 0; j < n; ++j)
                K(i, j) = kernel(d.x[std::size_t(i)], d.x[std::size_t(j)]);
        K.diagonal().array() += h.noiseStd * h.noiseStd;
        factor.compute(K);
        y = Eigen::Map<const Eigen::VectorXd>(d.y.data(), n);
        alpha = factor.solve(y);
    }

    double kernel(double a, double b) const {
        const double d = (a - b) / h.lengthScale;
        return h.signalStd * h.signalStd * std::exp(-0.5 * d * d);
    }

    Prediction predict(double x) const {
        Eigen::VectorXd k(y.size());
        for (Eigen::Index i = 0; i < k.size(); ++i)
            k[i] = kernel(x, data.x[std::size_t(i)]);
        const double explained = factor.matrixL().solve(k).squaredNorm();
        return {k.dot(alpha), kernel(x, x) - explained + h.noiseStd * h.noiseStd};
    }

    double logMarginalLikelihood() const {
        const Eigen::MatrixXd L = factor.matrixL();
        return -0.5 * y.dot(alpha) - L.diagonal().array().log().sum() -
               0.5 * double(y.size()) * std::log(2 * M_PI);
    }
};

void expectEqualsDense(const Data& data, const GpHyperparameters& h) {
    const DenseGp dense(data, h);
    const GpPosterior posterior = regressionOf(data).condition(h);
    const double reference = dense.logMarginalLikelihood();
    EXPECT_NEAR(posterior.logMarginalLikelihood(), reference, 1e-6 * std::abs(reference));
    for (int i = 0; i <= 80; ++i) {
        const double x = -2 + 0.05 * i;
        const Prediction fast = posterior.predict(x), exact = dense.predict(x);
        EXPECT_NEAR(fast.mean, exact.mean, 1e-7) << x;
        EXPECT_NEAR(fast.variance, exact.variance, 1e-7 * exact.variance) << x;
    }
}

}  // namespace

TEST(GpRegression, EqualsTheDenseSolution) {
    expectEqualsDense(noisySine(600, 1), {0.9, 0.6, 0.05});
    expectEqualsDense(noisySine(600, 2), {2.0, 1.5, 0.2});
}

TEST(GpRegression, EqualsTheDenseSolutionAtTheShortestLengthScale) {
    expectEqualsDense(noisySine(500, 3), {1.0, GpRegression(-2, 2).minLengthScale(), 0.05});
}

TEST(GpRegression, EqualsTheDenseSolutionWithAGapInTheData) {
    Data data = noisySine(300, 4), half;
    for (std::size_t i = 0; i < data.x.size(); ++i) {
        if (data.x[i] > 0) continue;
        half.x.push_back(data.x[i]);
        half.y.push_back(data.y[i]);
    }
    expectEqualsDense(half, {0.9, 0.6, 0.05});
}

TEST(GpRegression, WithoutDataIsThePrior) {
    const GpRegression gp(-1, 3);
    const GpPosterior prior = gp.condition({2.0, 1.0, 0.5});
    EXPECT_EQ(prior.logMarginalLikelihood(), 0);
    for (const double x : {-1.0, 0.123, 1.0, 3.0}) {
        EXPECT_EQ(prior.predict(x).mean, 0);
        EXPECT_NEAR(prior.predict(x).variance, 4.25, 1e-10);
    }
}

TEST(GpRegression, OneDatumByHand) {
    GpRegression gp(-1, 1);
    gp.add(0.25, 3.0);
    const GpPosterior posterior = gp.condition({2.0, 1.0, 1.0});
    // k = 4: mean 4/5 y, variance 4 - 16/5 + 1 at the datum.
    EXPECT_NEAR(posterior.predict(0.25).mean, 2.4, 1e-10);
    EXPECT_NEAR(posterior.predict(0.25).variance, 1.8, 1e-10);
    EXPECT_NEAR(posterior.logMarginalLikelihood(), -0.5 * std::log(2 * M_PI * 5) - 0.9,
                1e-10);
}

TEST(GpRegression, LikelihoodIsLargestAtTheFittedHyperparameters) {
    const GpRegression gp = regressionOf(noisySine(500, 5));
    const GpHyperparameters h = gp.maximiseLikelihood({});
    EXPECT_NEAR(h.noiseStd, 0.05, 0.006);  // 2 sqrt(2 n) standard deviations
    const double best = gp.condition(h).logMarginalLikelihood();
    for (const double factor : {0.97, 1.03}) {
        EXPECT_LT(gp.condition({h.signalStd * factor, h.lengthScale, h.noiseStd})
                      .logMarginalLikelihood(),
                  best);
        EXPECT_LT(gp.condition({h.signalStd, h.lengthScale * factor, h.noiseStd})
                      .logMarginalLikelihood(),
                  best);
        EXPECT_LT(gp.condition({h.signalStd, h.lengthScale, h.noiseStd * factor})
                      .logMarginalLikelihood(),
                  best);
    }
}

TEST(GpRegression, RefusesBadInput) {
    const double nan = std::numeric_limits<double>::quiet_NaN();
    EXPECT_THROW(GpRegression(1, 1), std::invalid_argument);
    EXPECT_THROW(GpRegression(0, nan), std::invalid_argument);
    GpRegression gp(-1, 1);
    EXPECT_THROW(gp.add(1.1, 0), std::invalid_argument);
    EXPECT_THROW(gp.add(nan, 0), std::invalid_argument);
    EXPECT_THROW(gp.add(0, nan), std::invalid_argument);
    EXPECT_EQ(gp.size(), 0U);
    EXPECT_THROW(gp.condition({0, 1, 1}), std::invalid_argument);
    EXPECT_THROW(gp.condition({1, nan, 1}), std::invalid_argument);
    EXPECT_THROW(gp.condition({1, 0.01, 1}), std::invalid_argument);
    EXPECT_THROW(gp.condition({}).predict(-1.5), std::invalid_argument);
}
