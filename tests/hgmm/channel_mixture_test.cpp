#include "modality/channel_mixture.h"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <stdexcept>

namespace hgmm {
namespace {

ChannelGaussian componentAt(double at) {
    ChannelGaussian g;
    g.place.support = 10;
    g.place.mean = Eigen::Vector3d(at, 0, 1);
    g.place.covariance << 0.5, 0.1, 0, 0.1, 0.25, 0.05, 0, 0.05, 0.125;
    g.fits[0] = {0.5, {1, 2, 3}, 0.25};
    g.fits[1] = {0.75, {-1, 0, 0.5}, 0.125};
    return g;
}

TEST(ChannelMixture, JointIsTheGaussianOfPlaceAndChannel) {
    const Gaussian<4> joint = componentAt(2).joint(1);
    const Eigen::Matrix3d XX = joint.covariance.topLeftCorner<3, 3>();
    const Eigen::Vector3d XL = joint.covariance.topRightCorner<3, 1>();
    EXPECT_LT((XX.inverse() * XL - Eigen::Vector3d(-1, 0, 0.5)).norm(), 1e-12);
    EXPECT_NEAR(joint.covariance(3, 3) - XL.dot(XX.inverse() * XL), 0.125, 1e-12);
    EXPECT_EQ(joint.mean[3], 0.75);
    EXPECT_TRUE(joint.covariance.isApprox(joint.covariance.transpose()));
}

TEST(ChannelMixture, KeepsComponentsAndChannels) {
    ChannelMixture mixture(2);
    mixture.pushBack(componentAt(1));
    mixture.pushBack(componentAt(2));
    mixture.set(0, componentAt(5));
    EXPECT_EQ(mixture.size(), 2U);
    EXPECT_EQ(mixture[0].place.mean[0], 5);
    EXPECT_EQ(mixture[1].fits[1].slope, Eigen::Vector3d(-1, 0, 0.5));
    EXPECT_NO_THROW(mixture.check());
    EXPECT_NO_THROW(mixture.joint(0).check());
    const ChannelMixture second = mixture.withChannels({1});
    EXPECT_EQ(second.channels(), 1);
    EXPECT_EQ(second.mean(0, 1), 0.75F);
    EXPECT_TRUE(second.places() == mixture.places());
    EXPECT_FALSE(second == mixture.withChannels({0}));
    EXPECT_THROW(ChannelMixture(0), std::invalid_argument);
    EXPECT_THROW(ChannelMixture(kMaxModalities + 1), std::invalid_argument);
}

TEST(ChannelMixture, DegenerateFitsBecomeUsable) {
    ChannelMixture mixture(2);
    ChannelGaussian flat = componentAt(0);
    flat.fits[0].residual = 0;
    flat.place.covariance = Eigen::Vector3d(1, 1, 1e-14).asDiagonal();
    mixture.pushBack(flat);
    EXPECT_NO_THROW(mixture.check());
    EXPECT_NO_THROW(mixture.joint(0).check());
    ChannelGaussian broken = componentAt(0);
    broken.fits[1].mean = NAN;
    mixture.pushBack(broken);
    EXPECT_THROW(mixture.check(), std::logic_error);
}

}  // namespace
}  // namespace hgmm
