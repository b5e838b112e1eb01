#include "localisation/likelihood_kernel.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <vector>

using hgmm::mrpt_bridge::fixedKernel;
using hgmm::mrpt_bridge::kernelFor;
using hgmm::mrpt_bridge::LikelihoodKernel;
using hgmm::mrpt_bridge::LikelihoodParams;
using hgmm::mrpt_bridge::PoseSpread;
using hgmm::mrpt_bridge::PoseSums;

namespace {

void expectKernel(const LikelihoodKernel& k, double width_m, double outlierRatio,
                  double independentPoints) {
    EXPECT_NEAR(k.kernelWidth_m, width_m, 1e-12);
    EXPECT_NEAR(k.outlierRatio, outlierRatio, 1e-12);
    EXPECT_NEAR(k.independentPoints, independentPoints, 1e-9);
}

TEST(LikelihoodKernel, IsWideWhereNothingIsKnownAndNarrowWhereAllPosesAgree) {
    expectKernel(kernelFor(std::nullopt), 0.2, 0.3, 15);
    expectKernel(kernelFor(PoseSpread{6, 1}), 0.2, 0.3, 15);
    expectKernel(kernelFor(PoseSpread{0, 0}), 0.02, 0.05, 60);
    expectKernel(kernelFor(PoseSpread{0.2, 0.1}), 0.02, 0.05, 60);
}

TEST(LikelihoodKernel, FewIndependentPointsTakeFewerPoints) {
    EXPECT_EQ(kernelFor(PoseSpread{0, 0}).shareOfPoints, 1);
    EXPECT_EQ(kernelFor(std::nullopt).shareOfPoints, 0.5);
    EXPECT_NEAR(kernelFor(PoseSpread{std::sqrt(0.2 * 0.6), 0}).shareOfPoints,
                std::sqrt(0.5), 1e-12);
    LikelihoodParams params;
    params.independentPoints = 5;
    EXPECT_EQ(fixedKernel(params)->shareOfPoints, 1);
}

TEST(LikelihoodKernel, EitherSpreadWidensIt) {
    // Half way, by the logarithm.
    const double metres = std::sqrt(0.2 * 0.6), radians = std::sqrt(0.1 * 0.3);
    for (const PoseSpread& spread :
         {PoseSpread{metres, 0}, PoseSpread{0, radians}, PoseSpread{metres, radians}})
        expectKernel(kernelFor(spread), std::sqrt(0.02 * 0.2), std::sqrt(0.05 * 0.3), 30);
    expectKernel(kernelFor(PoseSpread{0, 0.4}), 0.2, 0.3, 15);
}

TEST(LikelihoodKernel, NeverJumps) {
    LikelihoodKernel last = kernelFor(PoseSpread{0.1, 0});
    for (double metres = 0.1; metres < 1; metres *= 1.005) {
        const LikelihoodKernel k = kernelFor(PoseSpread{metres, 0});
        EXPECT_GE(k.kernelWidth_m, last.kernelWidth_m);
        EXPECT_LT(k.kernelWidth_m, 1.2 * last.kernelWidth_m);
        EXPECT_GE(k.outlierRatio, last.outlierRatio);
        EXPECT_LE(k.independentPoints, last.independentPoints);
        last = k;
    }
}

TEST(LikelihoodKernel, OneOptionThatIsSetFixesAll) {
    EXPECT_FALSE(fixedKernel(LikelihoodParams()));
    LikelihoodParams params;
    params.maxPoints = 7;
    EXPECT_FALSE(fixedKernel(params)) << "the number of points is not of the kernel";
    params.kernelWidth_m = 0.5;
    expectKernel(*fixedKernel(params), 0.5, 0.05, 60);
    params = {};
    params.outlierRatio = 0.4;
    expectKernel(*fixedKernel(params), 0.02, 0.4, 60);
    params = {};
    params.independentPoints = 3;
    expectKernel(*fixedKernel(params), 0.02, 0.05, 3);
}

struct Posed {
    Eigen::Vector3d t;
    Eigen::Matrix3d R;
};

std::vector<Posed> randomPoses(const Eigen::Vector3d& at, double metres, double radians,
                               int n) {
    std::mt19937_64 engine(5);
    std::normal_distribution<double> normal;
    std::vector<Posed> poses;
    for (int i = 0; i < n; ++i) {
        const Eigen::Vector3d offset(normal(engine), normal(engine), normal(engine));
        const Eigen::AngleAxisd turn(1 + radians * normal(engine),
                                     Eigen::Vector3d::UnitZ());
        poses.push_back({at + metres * offset, turn.toRotationMatrix()});
    }
    return poses;
}

PoseSums sumsOf(const std::vector<Posed>& poses) {
    PoseSums sums;
    for (const Posed& pose : poses) sums.add(pose.t, pose.R);
    return sums;
}

TEST(PoseSums, AreThoseOfTwoPassesAlsoFarAway) {
    for (const double away_m : {0.0, -5000.0, 40000.0}) {
        const auto poses = randomPoses({away_m, 2 * away_m / 3, 1}, 0.1, 0.05, 2000);
        Eigen::Vector3d mean = Eigen::Vector3d::Zero();
        for (const Posed& pose : poses) mean += pose.t / double(poses.size());
        double squares = 0;
        for (const Posed& pose : poses) squares += (pose.t - mean).squaredNorm();
        const PoseSums sums = sumsOf(poses);
        EXPECT_EQ(sums.count(), poses.size());
        EXPECT_NEAR(sums.squaredDistances(), squares, 1e-3 * squares) << away_m;
        EXPECT_NEAR(sums.squaredAngles() / double(poses.size()), 0.05 * 0.05, 2e-4);
    }
}

TEST(PoseSums, DoNotDependOnTheOrder) {
    auto poses = randomPoses({300, -70, 2}, 3, 2, 3000);
    const PoseSums sums = sumsOf(poses);
    std::shuffle(poses.begin(), poses.end(), std::mt19937_64(3));
    const PoseSums others = sumsOf(poses);
    EXPECT_EQ(sums.squaredDistances(), others.squaredDistances());
    EXPECT_EQ(sums.squaredAngles(), others.squaredAngles());
}

TEST(PoseSums, AnyHeadingIsARadian) {
    PoseSums sums;
    for (int i = 0; i < 360; ++i)
        sums.add(
            Eigen::Vector3d::Zero(),
            Eigen::AngleAxisd(i * M_PI / 180, Eigen::Vector3d::UnitZ()).toRotationMatrix());
    EXPECT_NEAR(sums.squaredAngles(), 360, 0.1);
    EXPECT_EQ(sums.squaredDistances(), 0);
}

TEST(PoseSums, LeaveOutWhatIsNotFinite) {
    PoseSums sums;
    EXPECT_EQ(sums.squaredDistances(), 0);
    EXPECT_EQ(sums.squaredAngles(), 0);
    sums.add({std::numeric_limits<double>::quiet_NaN(), 0, 0}, Eigen::Matrix3d::Identity());
    sums.add({0, std::numeric_limits<double>::infinity(), 0}, Eigen::Matrix3d::Identity());
    EXPECT_EQ(sums.count(), 0U);
    sums.add({1e300, -1e300, 0}, Eigen::Matrix3d::Identity());
    EXPECT_EQ(sums.squaredDistances(), 0);
}

}  // namespace
