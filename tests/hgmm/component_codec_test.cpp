#include "io/component_codec.h"

#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <iostream>

#include "hgmm/regression.h"
#include "mixture/regularized.h"
#include "planted_mixture.h"

namespace hgmm {
namespace {

using test::normal;
using test::randomCovariance;
using test::uniform;

/// Tiny and huge, round and a thousand times longer than thick, up to 1 km away.
Gaussian<3> randomSurface(std::mt19937_64& engine, double maxRatio) {
    Gaussian<3> g;
    g.support = std::exp(uniform(engine, -1, 15));
    for (int d = 0; d < 3; ++d) g.mean[d] = uniform(engine, -1000, 1000);
    const double scale = std::exp(uniform(engine, std::log(0.01), std::log(20.0)));
    g.covariance = scale * scale * randomCovariance<3>(engine, maxRatio);
    g.covariance.diagonal().array() += 1e-6;
    return regularized(g);
}

ViewDirection randomView(std::mt19937_64& engine) {
    ViewDirection view;
    if (engine() % 20 == 0) return view;
    view.direction = Eigen::Vector3d(normal(engine), normal(engine), normal(engine));
    if (engine() % 20 == 0) view.direction = -Eigen::Vector3d::Unit(engine() % 3);
    view.direction.normalize();
    view.range_m = std::exp(uniform(engine, std::log(0.06), std::log(300.0)));
    return view;
}

/// A plane or needle of 1 mm by 1 m in one of many orientations, or a random component.
struct Surfaces {
    Mixture<3> mixture;
    ViewDirections views;

    explicit Surfaces(std::size_t n, double maxRatio, std::uint64_t seed) {
        std::mt19937_64 engine(seed);
        for (std::size_t i = 0; i < n; ++i) {
            Gaussian<3> g = randomSurface(engine, maxRatio);
            if (i % 4 == 0 && maxRatio > 100) {
                Eigen::Vector3d sigma(1, i % 8 == 0 ? 1 : 1e-3, 1e-3);
                const Eigen::Matrix3d axes =
                    Eigen::Quaterniond(normal(engine), normal(engine), normal(engine),
                                       normal(engine))
                        .normalized()
                        .toRotationMatrix();
                g.covariance = axes * sigma.cwiseAbs2().asDiagonal() * axes.transpose();
                g = regularized(g);
            }
            mixture.pushBack(g);
            views.pushBack(randomView(engine));
        }
    }
};

std::vector<std::uint8_t> encoded(const Mixture<3>& mixture, const ViewDirections& views) {
    std::vector<std::uint8_t> bytes;
    encodeSurfaces(mixture, views, blockOrder(mixture), bytes);
    return bytes;
}

TEST(ComponentCodec, SurfacesEncodeToTheSameBytesAgain) {
    for (const double ratio : {3.0, 30.0, 1000.0}) {
        const Surfaces original(20000, ratio, 1);
        const auto bytes = encoded(original.mixture, original.views);
        Mixture<3> mixture;
        ViewDirections views;
        ASSERT_EQ(decodeSurfaces(bytes.data(), bytes.size(), mixture, views), bytes.size());
        mixture.check();
        EXPECT_EQ(mixture.size(), original.mixture.size());
        EXPECT_TRUE(encoded(mixture, views) == bytes) << "ratio " << ratio;
    }
}

/// The whitened covariance of `b` seen from `a` has eigenvalues 1 where they agree.
Eigen::Vector3d relativeVariances(const Gaussian<3>& a, const Gaussian<3>& b) {
    const Eigen::Matrix3d A = a.covariance, B = b.covariance;
    return Eigen::GeneralizedSelfAdjointEigenSolver<Eigen::Matrix3d>(B, A).eigenvalues();
}

TEST(ComponentCodec, SurfaceErrorsAreWithinTheTable) {
    std::mt19937_64 engine(2);
    double worstMean = 0, worstSigma = 0, worstSupport = 0, worstAngle = 0, worstRange = 0;
    for (int i = 0; i < 5000; ++i) {
        Mixture<3> one, back;
        ViewDirections view, backView;
        one.pushBack(randomSurface(engine, 100));
        view.pushBack(randomView(engine));
        const auto bytes = encoded(one, view);
        EXPECT_EQ(bytes.size(), 4U + 16U + 20U);
        decodeSurfaces(bytes.data(), bytes.size(), back, backView);
        const Gaussian<3> a = one[0], b = back[0];
        worstMean = std::max(worstMean, (a.mean - b.mean).cwiseAbs().maxCoeff());
        const Eigen::Vector3d r = relativeVariances(a, b).cwiseSqrt();
        worstSigma = std::max(worstSigma, (r.array() - 1).abs().maxCoeff());
        worstSupport = std::max(worstSupport, std::abs(b.support / a.support - 1));
        ASSERT_EQ(view[0].known(), backView[0].known());
        if (!view[0].known()) continue;
        worstAngle = std::max(
            worstAngle,
            std::acos(std::min(1.0, view[0].direction.dot(backView[0].direction))));
        worstRange =
            std::max(worstRange, std::abs(backView[0].range_m / view[0].range_m - 1));
    }
    std::cout << "codec: errors up to " << 1e3 * worstMean << " mm, " << 100 * worstSigma
              << " % of sigma, " << 100 * worstSupport << " % of support, "
              << worstAngle * 180 / M_PI << " deg, " << 100 * worstRange << " % of range\n";
    EXPECT_LT(worstMean, 0.00020);  // 0.13 mm and the rounding of floats at 1 km
    // 2.8 % of the diagonal, 1.6 % for each of the two entries beside it.
    EXPECT_LT(worstSigma, 0.06);
    EXPECT_LT(worstSupport, 4e-4);
    EXPECT_LT(worstAngle, 0.9 * M_PI / 180);
    EXPECT_LT(worstRange, 0.026);
}

TEST(ComponentCodec, NegativeBlocksAndExtremesStayFinite) {
    Mixture<3> mixture, back;
    ViewDirections views, backViews;
    for (const double p : {-1e3, -16.0, -1e-9, 0.0, 15.9999999, 16.0, 1e3})
        for (const double sigma : {1e-6, 1e-3, 1e3}) {
            Gaussian<3> g;
            g.support = sigma < 1 ? 1e-3 : 1e9;
            g.mean.setConstant(p);
            g.covariance = sigma * sigma * Eigen::Matrix3d::Identity();
            mixture.pushBack(g);
            views.pushBack({});
        }
    const auto bytes = encoded(mixture, views);
    decodeSurfaces(bytes.data(), bytes.size(), back, backViews);
    back.check();
    ASSERT_EQ(back.size(), mixture.size());
    EXPECT_TRUE(encoded(back, backViews) == bytes);
    auto sorted = mixture.mean[0], sortedBack = back.mean[0];
    std::sort(sorted.begin(), sorted.end());
    std::sort(sortedBack.begin(), sortedBack.end());
    for (std::size_t i = 0; i < sorted.size(); ++i)
        EXPECT_NEAR(sorted[i], sortedBack[i], 2e-4);
}

/// Slabs of free space, from flat to round, with W along them.
Gaussian<4> randomFree(std::mt19937_64& engine) {
    Gaussian<4> g;
    const Gaussian<3> place = randomSurface(engine, 200);
    g.support = place.support;
    g.mean.head<3>() = place.mean;
    g.mean[3] = std::exp(uniform(engine, std::log(0.5), std::log(200.0)));
    Eigen::Vector3d slope(normal(engine), normal(engine), normal(engine));
    slope.normalize();
    const Eigen::Matrix3d covariance =
        place.covariance + 1e-4 * Eigen::Matrix3d::Identity();
    const Eigen::Vector3d cross = covariance * slope;
    const double residual = std::exp(uniform(engine, std::log(0.01), std::log(5.0)));
    g.covariance.topLeftCorner<3, 3>() = covariance;
    g.covariance.topRightCorner<3, 1>() = cross;
    g.covariance.bottomLeftCorner<1, 3>() = cross.transpose();
    g.covariance(3, 3) = slope.dot(cross) + residual * residual;
    return regularized(g);
}

TEST(ComponentCodec, FreeSpaceEncodesToTheSameBytesAgain) {
    std::mt19937_64 engine(3);
    Mixture<4> mixture, back;
    std::vector<int> octaves, backOctaves;
    for (int i = 0; i < 20000; ++i) {
        mixture.pushBack(randomFree(engine));
        octaves.push_back(static_cast<int>(engine() % 41) - 20);
    }
    std::vector<std::uint8_t> bytes, again;
    encodeFree(mixture, octaves, blockOrder(mixture), bytes);
    ASSERT_EQ(decodeFree(bytes.data(), bytes.size(), back, backOctaves), bytes.size());
    back.check();
    encodeFree(back, backOctaves, blockOrder(back), again);
    EXPECT_TRUE(again == bytes);
    std::sort(octaves.begin(), octaves.end());
    std::sort(backOctaves.begin(), backOctaves.end());
    EXPECT_EQ(octaves, backOctaves);
}

TEST(ComponentCodec, FreeSpaceErrorsAreWithinTheTable) {
    std::mt19937_64 engine(4);
    for (int i = 0; i < 2000; ++i) {
        Gaussian<4> g = randomFree(engine);
        Mixture<4> one, back;
        one.pushBack(g);
        std::vector<int> octaves{3}, backOctaves;
        std::vector<std::uint8_t> bytes;
        encodeFree(one, octaves, {0}, bytes);
        EXPECT_EQ(bytes.size(), 4U + 16U + 23U);
        decodeFree(bytes.data(), bytes.size(), back, backOctaves);
        EXPECT_EQ(backOctaves, octaves);
        g = one[0];
        const Gaussian<4> b = back[0];
        EXPECT_LT((g.mean.head<3>() - b.mean.head<3>()).cwiseAbs().maxCoeff(), 2e-4);
        EXPECT_NEAR(b.mean[3] / g.mean[3], 1, 0.035);
    }
}

TEST(ComponentCodec, EveryTruncationThrows) {
    const Surfaces original(30, 30, 5);
    const auto bytes = encoded(original.mixture, original.views);
    for (std::size_t size = 0; size < bytes.size(); ++size) {
        Mixture<3> mixture;
        ViewDirections views;
        EXPECT_THROW(decodeSurfaces(bytes.data(), size, mixture, views), std::out_of_range);
    }
    // A count that promises more than there is.
    auto greedy = bytes;
    greedy[0] = greedy[1] = greedy[2] = greedy[3] = 0xFF;
    Mixture<4> mixture;
    std::vector<int> octaves;
    EXPECT_THROW(decodeFree(greedy.data(), greedy.size(), mixture, octaves),
                 std::out_of_range);
}

TEST(ComponentCodec, NothingGivesNothing) {
    const auto bytes = encoded({}, {});
    EXPECT_EQ(bytes.size(), 4U);
    Mixture<3> mixture;
    ViewDirections views;
    EXPECT_EQ(decodeSurfaces(bytes.data(), bytes.size(), mixture, views), 4U);
    EXPECT_TRUE(mixture.empty());
}

}  // namespace
}  // namespace hgmm
