#include "modality/linear_split.h"

#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <algorithm>
#include <random>

#include "coloured_scenes.h"
#include "modality/channel_sums.h"

namespace hgmm {
namespace {

using testing::paintedWall;
using testing::patches;
using testing::plain;

ChannelSamples samplesOf(const Scan& scan) {
    std::vector<const Channel*> channels;
    for (const Channel& channel : scan.channels) channels.push_back(&channel);
    return filterChannels(scan, channels, FilterParams(), ModalityParams());
}

/// The wall as one region.
std::vector<LinearRegion> oneRegion(const ChannelSamples& samples) {
    std::vector<LinearRegion> regions(1);
    for (std::uint32_t i = 0; i < samples.size(); ++i) regions[0].samples.push_back(i);
    return regions;
}

ChannelGaussian someComponent() {
    ChannelGaussian g;
    g.place.support = 100;
    g.place.mean = Eigen::Vector3d(1, 2, 3);
    g.place.covariance << 0.04, 0.01, 0, 0.01, 0.09, 0.002, 0, 0.002, 0.01;
    g.fits[0] = {0.4, {1, -2, 0.5}, 0.01};
    return g;
}

TEST(ChannelFilter, SumsAreThoseOfThePoints) {
    const auto warm = [](double y, double z) { return 295.0 + y - z; };
    Scan scan = paintedWall({{"t", warm}, {"r", plain(0.3)}});
    scan.channels[0].values[7] = scan.channels[1].values[7] = NAN;
    const ChannelSamples samples = samplesOf(scan);
    ChannelSums sums(2), expected(2);
    for (std::size_t i = 0; i < samples.size(); ++i) sums.add(samples.sums(i));
    EXPECT_EQ(sums.count(), double(scan.size() - 1));
    Eigen::Vector3d mean = Eigen::Vector3d::Zero();
    double value = 0, values = 0;
    for (std::size_t i = 0; i < scan.size(); ++i) {
        if (i == 7) continue;
        mean += Eigen::Vector3d(scan.x[i], scan.y[i], scan.z[i]);
        value += scan.channels[0].values[i];
    }
    value /= sums.count();
    for (std::size_t i = 0; i < scan.size(); ++i)
        if (i != 7) values += std::pow(scan.channels[0].values[i] - value, 2);
    EXPECT_LT((sums.mean() - mean / sums.count()).norm(), 1e-6);
    std::array<double, kMaxModalities> spread{};
    sums.spread(spread);
    const double noise = ModalityParams().modalityNoise;
    EXPECT_NEAR(spread[0] / sums.count() - noise * noise, values / sums.count(), 1e-4);
    EXPECT_NEAR(sums.gaussian(1e-10).fits[0].mean, value, 1e-4);
    EXPECT_NEAR(sums.gaussian(1e-10).fits[0].slope.y(), 1.0, 0.01);
}

TEST(LinearSplit, ALineStaysWhole) {
    const ChannelSamples samples =
        samplesOf(paintedWall({{"r", [](double y, double z) { return 0.5 + y - z; }}}));
    EXPECT_EQ(splitWhereNotLinear(samples, oneRegion(samples), ModalityParams()).size(),
              1U);
}

TEST(LinearSplit, NoiseStaysWhole) {
    std::mt19937_64 random(1);
    std::normal_distribution<double> noise(0.5, 0.1);
    const ChannelSamples samples =
        samplesOf(paintedWall({{"r", [&](double, double) { return noise(random); }}}));
    EXPECT_LE(splitWhereNotLinear(samples, oneRegion(samples), ModalityParams()).size(),
              3U);
}

TEST(LinearSplit, EdgesAreFoundAndEverySampleIsKeptOnce) {
    const ChannelSamples samples =
        samplesOf(paintedWall({{"r", patches({0.1, 0.9})}, {"g", plain(0.5)}}));
    ModalityParams params;
    params.modalityUnexplained = 0.01;
    const auto regions = splitWhereNotLinear(samples, oneRegion(samples), params);
    ASSERT_GT(regions.size(), 1U);
    EXPECT_LT(regions.size(), 60U);
    std::vector<std::uint32_t> all;
    for (const LinearRegion& region : regions) {
        EXPECT_TRUE(std::is_sorted(region.samples.begin(), region.samples.end()));
        all.insert(all.end(), region.samples.begin(), region.samples.end());
    }
    std::sort(all.begin(), all.end());
    for (std::uint32_t i = 0; i < all.size(); ++i) ASSERT_EQ(all[i], i);
    EXPECT_EQ(all.size(), samples.size());
}

TEST(LinearSplit, OnePartStandsForTheComponentAndPriorsAreShared) {
    const ChannelSamples samples = samplesOf(paintedWall({{"r", patches({0.1, 0.9})}}));
    auto regions = oneRegion(samples);
    regions[0].component = 17;
    ChannelGaussian prior = someComponent();
    prior.place.mean = Eigen::Vector3d(2, 0, 0);
    regions[0].prior = prior;
    const auto parts = splitWhereNotLinear(samples, regions, ModalityParams());
    ASSERT_GT(parts.size(), 1U);
    double support = 0;
    std::size_t standing = 0;
    for (const LinearRegion& part : parts) {
        standing += part.component == 17 ? 1 : 0;
        if (part.prior) support += part.prior->place.support;
    }
    EXPECT_EQ(standing, 1U);
    EXPECT_NEAR(support, 100, 1e-9);
}

TEST(LinearSplit, CutKeepsMoments) {
    const ChannelGaussian whole = someComponent();
    const Eigen::Vector3d direction = Eigen::Vector3d(1, 2, -0.5).normalized();
    const double middle = direction.dot(Eigen::Vector3d(whole.place.mean));
    for (const double offset : {-0.3, 0.0, 0.2}) {
        const CutComponent parts = cut(whole, 1, direction, middle + offset);
        ASSERT_TRUE(parts.below && parts.above);
        const Gaussian<4> together =
            mergeMoments(parts.below->joint(0), parts.above->joint(0));
        EXPECT_NEAR(together.support, 100, 1e-9);
        EXPECT_LT((together.mean - whole.joint(0).mean).norm(), 1e-9);
        EXPECT_LT((together.covariance - whole.joint(0).covariance).norm(), 1e-9);
        EXPECT_LT(direction.dot(Eigen::Vector3d(parts.below->place.mean)), middle + offset);
        EXPECT_GT(direction.dot(Eigen::Vector3d(parts.above->place.mean)), middle + offset);
    }
    EXPECT_FALSE(cut(whole, 1, direction, middle + 10).above);
    EXPECT_FALSE(cut(whole, 1, direction, middle - 10).below);
}

/// The parts are the moments of samples on either side.
TEST(LinearSplit, CutIsThatOfSamples) {
    const ChannelGaussian whole = someComponent();
    const Eigen::Vector3d direction = Eigen::Vector3d::UnitY();
    const CutComponent parts = cut(whole, 1, direction, 2.1);
    const Eigen::Matrix4d L = Eigen::Matrix4d(whole.joint(0).covariance).llt().matrixL();
    std::mt19937_64 random(4);
    std::normal_distribution<double> normal(0.0, 1.0);
    double n = 0, drawn = 400000;
    Eigen::Vector4d sum = Eigen::Vector4d::Zero();
    Eigen::Matrix4d outer = Eigen::Matrix4d::Zero();
    for (int k = 0; k < drawn; ++k) {
        Eigen::Vector4d v(normal(random), normal(random), normal(random), normal(random));
        v = L * v + Eigen::Vector4d(whole.joint(0).mean);
        if (v[1] >= 2.1) continue;
        n += 1, sum += v, outer += v * v.transpose();
    }
    const Gaussian<4> below = parts.below->joint(0);
    EXPECT_NEAR(below.support, 100 * n / drawn, 0.5);
    EXPECT_LT((Eigen::Vector4d(below.mean) - sum / n).norm(), 0.01);
    const Eigen::Matrix4d covariance = outer / n - sum * sum.transpose() / n / n;
    EXPECT_LT((Eigen::Matrix4d(below.covariance) - covariance).norm(),
              0.02 * covariance.norm());
}

}  // namespace
}  // namespace hgmm
