#include "hgmm/slam/uncertain_pose.h"

#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <random>

namespace hgmm::slam {
namespace {

UncertainPose somePose(double x, double yaw, double pitch, double scale) {
    UncertainPose pose;
    pose.T_a_b.R = rotationOf({0.1, pitch, yaw});
    pose.T_a_b.t = {x, 2.0, -1.0};
    Matrix6d root = Matrix6d::Identity();
    root(3, 0) = 0.5;
    root(4, 2) = -0.8;
    root(1, 0) = 0.3;
    pose.covariance = scale * scale * root * root.transpose();
    return pose;
}

/// Draws true poses and compares the scatter of their errors with a covariance.
template <typename Draw>
void expectScatter(const Pose& expected, const Matrix6d& covariance, Draw&& draw) {
    std::mt19937_64 random(7);
    Matrix6d scatter = Matrix6d::Zero();
    constexpr int kDraws = 20000;
    for (int k = 0; k < kDraws; ++k) {
        const Vector6d error = errorOf(draw(random), expected);
        scatter += error * error.transpose() / kDraws;
    }
    const double largest = covariance.diagonal().maxCoeff();
    EXPECT_LT((scatter - covariance).cwiseAbs().maxCoeff(), 0.05 * largest)
        << scatter << "\n\n"
        << covariance;
}

Pose drawnFrom(const UncertainPose& pose, std::mt19937_64& random) {
    std::normal_distribution<double> normal;
    Eigen::Matrix<double, 6, 1> z;
    for (int i = 0; i < 6; ++i) z[i] = normal(random);
    const Eigen::Matrix<double, 6, 6> covariance = pose.covariance;
    return displacedBy(pose.T_a_b, Vector6d(covariance.llt().matrixL() * z));
}

TEST(UncertainPose, ComposedCovarianceIsThatOfDrawnPoses) {
    const UncertainPose a = somePose(3.0, 0.7, -0.4, 0.01);
    const UncertainPose b = somePose(-5.0, 2.0, 0.3, 0.02);
    const UncertainPose both = a * b;
    EXPECT_LT(errorOf(both.T_a_b, a.T_a_b * b.T_a_b).norm(), 1e-12);
    expectScatter(both.T_a_b, both.covariance, [&](std::mt19937_64& random) {
        const Pose first = drawnFrom(a, random);
        return first * drawnFrom(b, random);
    });
}

TEST(UncertainPose, InverseCovarianceIsThatOfDrawnPoses) {
    const UncertainPose a = somePose(3.0, 0.7, -0.4, 0.01);
    const UncertainPose back = a.inverse();
    expectScatter(back.T_a_b, back.covariance,
                  [&](std::mt19937_64& random) { return drawnFrom(a, random).inverse(); });
}

TEST(UncertainPose, ErrorsAndPosesAreInverse) {
    const Pose pose = somePose(1.0, 3.0, 0.2, 1.0).T_a_b;
    Vector6d error;
    error << 0.3, -2.0, 0.7, 1.0, 2.0, 3.0;
    EXPECT_LT((errorOf(displacedBy(pose, error), pose) - error).norm(), 1e-9);
}

TEST(UncertainPose, MahalanobisCountsSigmas) {
    Matrix6d covariance = Matrix6d::Identity();
    covariance(4, 4) = 0.04;
    Vector6d error = Vector6d::Zero();
    error[4] = 0.6;
    EXPECT_NEAR(squaredMahalanobis(error, covariance), 9.0, 1e-6);
}

}  // namespace
}  // namespace hgmm::slam
