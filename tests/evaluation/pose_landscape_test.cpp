#include "hgmm/evaluation/pose_landscape.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <atomic>
#include <cmath>
#include <mutex>

#include "hgmm/evaluation/split.h"

namespace hgmm::evaluation {
namespace {

constexpr double kDeg = M_PI / 180;

Pose tilted() {
    Pose pose;
    pose.R = (Eigen::AngleAxisd(0.7, Eigen::Vector3d::UnitZ()) *
              Eigen::AngleAxisd(0.3, Eigen::Vector3d::UnitX()))
                 .toRotationMatrix();
    pose.t << 1, -2, 0.5;
    return pose;
}

/// How far two poses are apart, a rotation by 1 rad counting as `lever` metres.
double squaredDistance(const Pose& a, const Pose& b, double lever) {
    const PoseError error = errorOf(a, b);
    return error.position_m * error.position_m +
           std::pow(lever * error.rotation_deg * kDeg, 2);
}

TEST(PoseLandscape, ErrorIsDistanceAndAngle) {
    Pose moved = tilted();
    moved.t += Eigen::Vector3d(0.3, 0, -0.4);
    moved.R = moved.R * Eigen::AngleAxisd(-5 * kDeg, Eigen::Vector3d(1, 2, 3).normalized())
                            .toRotationMatrix();
    EXPECT_NEAR(errorOf(moved, tilted()).position_m, 0.5, 1e-12);
    EXPECT_NEAR(errorOf(moved, tilted()).rotation_deg, 5, 1e-9);
    EXPECT_EQ(errorOf(tilted(), tilted()).position_m, 0);
    EXPECT_NEAR(errorOf(tilted(), tilted()).rotation_deg, 0, 1e-6);
}

TEST(PoseLandscape, DisplacedIsAsFarAsItSays) {
    auto stream = randomStream(1, 0, Draw::startPose);
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    for (int i = 0; i < 400; ++i) {
        const Pose pose = displaced(tilted(), 0.3, 5, false, stream);
        EXPECT_NEAR(errorOf(pose, tilted()).position_m, 0.3, 1e-12);
        EXPECT_NEAR(errorOf(pose, tilted()).rotation_deg, 5, 1e-9);
        sum += pose.t - tilted().t;
        const Pose planar = displaced(Pose{}, 0.3, 5, true, stream);
        EXPECT_EQ(planar.t.z(), 0);
        EXPECT_NEAR(planar.R(2, 2), 1, 1e-12);
    }
    // 0.3 / sqrt(3 * 400) a sigma of the mean.
    EXPECT_LT(sum.norm() / 400, 0.04) << "all directions are as likely";
}

/// Rotation and translation are tied: a ridge that runs across the axes of a pose, as that
/// of a depth camera, whose points are all before it.
TEST(PoseLandscape, ClimbsARidgeAboutThePivot) {
    const Pose top = tilted();
    const Eigen::Vector3d p(3, 1, 0);  // a point, in the frame of the pose
    const PoseScore score = [&](const Pose& pose) {
        return -5 * (pose.R * p + pose.t - (top.R * p + top.t)).squaredNorm() -
               squaredDistance(pose, top, 1.0);
    };
    const auto worstAbout = [&](const Eigen::Vector3d& pivot) {
        auto stream = randomStream(2, 0, Draw::startPose);
        PoseSearch search;
        search.lever_m = 3;
        search.pivot = pivot;
        PoseError worst;
        for (int i = 0; i < 20; ++i) {
            const PoseError end =
                errorOf(climb(score, displaced(top, 0.3, 5, false, stream), search), top);
            worst.position_m = std::max(worst.position_m, end.position_m);
            worst.rotation_deg = std::max(worst.rotation_deg, end.rotation_deg);
        }
        return worst;
    };
    const PoseError aboutOrigin = worstAbout(Eigen::Vector3d::Zero()),
                    aboutPoint = worstAbout(p);
    EXPECT_LT(aboutOrigin.position_m, 0.03);
    EXPECT_LT(aboutOrigin.rotation_deg, 0.8);
    EXPECT_LT(aboutPoint.position_m, 0.005);
    EXPECT_LT(aboutPoint.rotation_deg, 0.2);
}

TEST(PoseLandscape, PlanarSearchStaysInThePlane) {
    const PoseScore score = [](const Pose& pose) {
        return -(pose.t - Eigen::Vector3d(0.2, -0.1, 0.3)).squaredNorm();
    };
    PoseSearch search;
    search.planar = true;
    for (const Pose& start : {Pose{}, Pose{tilted().R, Eigen::Vector3d::Zero()}})
        for (const Eigen::Vector3d& pivot : {Eigen::Vector3d(0, 0, 0), {2, 1, 0.5}}) {
            search.pivot = pivot;
            const Pose end = climb(score, start, search);
            EXPECT_NEAR(end.t.x(), 0.2, 0.003);
            EXPECT_NEAR(end.t.y(), -0.1, 0.003);
            EXPECT_EQ(end.t.z(), 0);
        }
}

TEST(PoseLandscape, FindsTheHigherOfTwoHills) {
    const Pose truth = tilted();
    Pose other = truth;
    other.t.x() += 0.25;
    const PoseScore score = [&](const Pose& pose) {
        const double narrow = squaredDistance(pose, other, 1.0) / (2 * 0.06 * 0.06);
        const double wide = squaredDistance(pose, truth, 1.0) / (2 * 0.1 * 0.1);
        return std::max(1.2 * std::exp(-narrow), std::exp(-wide));
    };
    PoseSearch search;
    search.firstStep_m = 0.1;
    EXPECT_LT(errorOf(climb(score, truth, search), truth).position_m, 0.01)
        << "a climb alone stays on its hill";
    auto stream = randomStream(3, 0, Draw::startPose);
    const Pose highest = highestAround(score, truth, 0.3, 5, search, stream);
    EXPECT_LT(errorOf(highest, other).position_m, 0.01);
    EXPECT_LT(errorOf(highest, other).rotation_deg, 0.5);
}

TEST(PoseLandscape, LatticeReachesAsFarAsAsked) {
    double farthest_m = 0, farthest_deg = 0;
    std::atomic<int> calls{0};
    std::mutex mutex;
    const PoseScore score = [&](const Pose& pose) {
        const std::lock_guard<std::mutex> lock(mutex);
        farthest_m = std::max(farthest_m, pose.t.cwiseAbs().maxCoeff());
        farthest_deg = std::max(farthest_deg, errorOf(pose, {}).rotation_deg);
        ++calls;
        return 0.0;
    };
    PoseSearch search;
    search.planar = true;
    search.lever_m = 2;
    search.firstStep_m = 0.05;
    auto stream = randomStream(4, 0, Draw::startPose);
    highestAround(score, {}, 0.3, 5, search, stream);
    EXPECT_GT(farthest_m, 0.3 - 0.05);
    EXPECT_GT(farthest_deg, 5 - 0.05 / 2 / kDeg);
    // 13 x 13 nodes of 5 cm, 9 of 1.4 deg, and climbs.
    EXPECT_GT(calls, 13 * 13 * 9);
}

}  // namespace
}  // namespace hgmm::evaluation
