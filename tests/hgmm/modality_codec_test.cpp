#include "io/modality_codec.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <random>
#include <stdexcept>

namespace hgmm {
namespace {

/// Flat components of all sizes and directions, some far away.
ChannelMixture tiles(std::size_t components) {
    std::mt19937_64 random(1);
    std::normal_distribution<double> normal(0.0, 1.0);
    std::uniform_real_distribution<double> even(0.0, 1.0);
    ChannelMixture mixture(3);
    for (std::size_t i = 0; i < components; ++i) {
        ChannelGaussian g;
        const Eigen::Quaterniond q = Eigen::Quaterniond(normal(random), normal(random),
                                                        normal(random), normal(random))
                                         .normalized();
        const Eigen::Vector3d sigma(0.005, 0.01 + 0.1 * even(random), 0.1);
        const Eigen::Matrix3d R = q.toRotationMatrix();
        g.place.covariance = R * sigma.cwiseAbs2().asDiagonal() * R.transpose();
        for (int d = 0; d < 3; ++d) g.place.mean[d] = 30 * normal(random);
        g.place.support = std::exp(8 * even(random));
        for (int c = 0; c < 3; ++c) {
            g.fits[c].mean = even(random);
            for (int d = 0; d < 3; ++d) g.fits[c].slope[d] = normal(random);
            g.fits[c].residual = std::pow(0.001 + 0.1 * even(random), 2);
        }
        mixture.pushBack(g);
    }
    return mixture;
}

ChannelMixture decoded(const std::vector<std::uint8_t>& bytes, int channels) {
    ChannelMixture mixture(channels);
    EXPECT_EQ(decodeChannels(bytes.data(), bytes.size(), mixture), bytes.size());
    return mixture;
}

TEST(ModalityCodec, ErrorsAreAsPromised) {
    const ChannelMixture mixture = tiles(300);
    std::vector<std::uint8_t> bytes;
    encodeChannels(mixture, bytes);
    const ChannelMixture back = decoded(bytes, 3);
    ASSERT_EQ(back.size(), mixture.size());
    EXPECT_NO_THROW(back.check());
    for (std::size_t i = 0; i < back.size(); ++i) {
        // Components come back sorted by block: found again by their means.
        std::size_t k = 0;
        double nearest = 1e9;
        for (std::size_t j = 0; j < mixture.size(); ++j) {
            const double d = (mixture[j].place.mean - back[i].place.mean).norm();
            if (d < nearest) nearest = d, k = j;
        }
        ASSERT_LT(nearest, 0.001);
        for (int c = 0; c < 3; ++c) {
            EXPECT_NEAR(back.mean(c, i), mixture.mean(c, k), 1e-5);
            EXPECT_NEAR(std::sqrt(back.residual(c, i) / mixture.residual(c, k)), 1, 0.06);
            // The channel one sigma away along the longest axis.
            const Gaussian<4> a = mixture[k].joint(c), b = back[i].joint(c);
            EXPECT_NEAR(b.covariance(3, 3), a.covariance(3, 3),
                        0.15 * a.covariance(3, 3) + 1e-4);
        }
    }
}

TEST(ModalityCodec, EncodingAgainGivesTheSameBytes) {
    for (const std::size_t components : {0U, 1U, 300U}) {
        std::vector<std::uint8_t> bytes, again;
        encodeChannels(tiles(components), bytes);
        encodeChannels(decoded(bytes, 3), again);
        EXPECT_TRUE(again == bytes) << components;
    }
}

TEST(ModalityCodec, TruncatedDataIsRefused) {
    std::vector<std::uint8_t> bytes;
    encodeChannels(tiles(5), bytes);
    for (std::size_t size = 0; size < bytes.size(); ++size) {
        ChannelMixture mixture(3);
        EXPECT_THROW(decodeChannels(bytes.data(), size, mixture), std::out_of_range);
    }
}

}  // namespace
}  // namespace hgmm
