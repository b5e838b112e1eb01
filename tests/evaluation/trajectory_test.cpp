#include "hgmm/evaluation/trajectory.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <Eigen/Geometry>
#include <cmath>
#include <filesystem>
#include <fstream>

using namespace hgmm::evaluation;
using Eigen::AngleAxisd;
using Eigen::Vector3d;

namespace {

hgmm::Pose makePose(const Vector3d& t, double angle, const Vector3d& axis) {
    return {AngleAxisd(angle, axis.normalized()).toRotationMatrix(), t};
}

double poseDistance(const hgmm::Pose& a, const hgmm::Pose& b) {
    return std::max((a.R - b.R).cwiseAbs().maxCoeff(), (a.t - b.t).cwiseAbs().maxCoeff());
}

class TrajectoryFile : public testing::Test {
 protected:
    void SetUp() override {
        file_ = (std::filesystem::temp_directory_path() /
                 ("hgmm-trajectory-" + std::to_string(getpid()) + ".txt"))
                    .string();
    }
    void TearDown() override { std::filesystem::remove(file_); }
    Trajectory read(const std::string& text) const {
        std::ofstream(file_) << text;
        return readTrajectory(file_);
    }
    void expectError(const std::string& text, const std::string& what) const {
        try {
            read(text);
            ADD_FAILURE() << "accepted: " << text;
        } catch (const std::runtime_error& e) {
            EXPECT_NE(std::string(e.what()).find(file_), std::string::npos) << e.what();
            EXPECT_NE(std::string(e.what()).find(what), std::string::npos) << e.what();
        }
    }
    std::string file_;
};

const Trajectory kTrajectory{{1305031102.175304, makePose({1, -2, 3}, 2.5, {1, 2, 3})},
                             {1305031102.275304, makePose({-4, 5e3, 6}, -3.1, {0, 1, -1})}};

}  // namespace

TEST_F(TrajectoryFile, ReadsTumLines) {
    // A quarter turn about z: (x, y, z, w) = (0, 0, sin 45, cos 45), not normalised here.
    const auto trajectory =
        read("# comment\n\n  \r\n1.5 1 2 3 0 0 2 2\r\n2.5\t4 5 6 0 0 0 -1\n");
    ASSERT_EQ(trajectory.size(), 2U);
    EXPECT_EQ(trajectory[0].stamp, 1.5);
    EXPECT_EQ(trajectory[0].T_world_frame.t, Vector3d(1, 2, 3));
    const Vector3d turned = trajectory[0].T_world_frame.R * Vector3d::UnitX();
    EXPECT_LT((turned - Vector3d::UnitY()).norm(), 1e-12);
    EXPECT_TRUE(trajectory[1].T_world_frame.R.isIdentity(1e-12));
}

TEST_F(TrajectoryFile, ReadsKittiLines) {
    const auto trajectory = read("0 -1 0 7 1 0 0 8 0 0 1 9\n1 0 0 0 0 1 0 0 0 0 1 0\n");
    ASSERT_EQ(trajectory.size(), 2U);
    EXPECT_EQ(trajectory[0].stamp, 0);
    EXPECT_NEAR(trajectory[1].stamp, kDefaultPosePeriod, 1e-12);
    EXPECT_LT(
        poseDistance(trajectory[0].T_world_frame, makePose({7, 8, 9}, M_PI / 2, {0, 0, 1})),
        1e-12);
}

TEST_F(TrajectoryFile, TumRoundTrip) {
    writeTumTrajectory(file_, kTrajectory);
    const auto trajectory = readTrajectory(file_);
    ASSERT_EQ(trajectory.size(), kTrajectory.size());
    for (std::size_t i = 0; i < trajectory.size(); ++i) {
        EXPECT_NEAR(trajectory[i].stamp, kTrajectory[i].stamp, 1e-6);
        EXPECT_LT(poseDistance(trajectory[i].T_world_frame, kTrajectory[i].T_world_frame),
                  1e-8);
    }
}

TEST_F(TrajectoryFile, KittiRoundTrip) {
    writeKittiTrajectory(file_, kTrajectory);
    const auto trajectory = readTrajectory(file_);
    ASSERT_EQ(trajectory.size(), kTrajectory.size());
    for (std::size_t i = 0; i < trajectory.size(); ++i)
        EXPECT_LT(poseDistance(trajectory[i].T_world_frame, kTrajectory[i].T_world_frame),
                  1e-8);
}

TEST_F(TrajectoryFile, ErrorsNameFileLineAndCause) {
    expectError("", "holds no poses");
    expectError("# only a comment\n", "holds no poses");
    expectError("0 1 2 3 0 0 0\n", ":1: expected 8 numbers");
    expectError("#\n0 1 2 3 0 0 0 1\n1 0 0 0 0 1 0 0 0 0 1 0\n",
                ":3: expected 8 numbers as");
    expectError("0 1 2 3 0 0 0 1e\n", ":1: '1e' is not a finite number");
    expectError("0 1 nan 3 0 0 0 1\n", "'nan' is not a finite number");
    expectError("0 1 1e999 3 0 0 0 1\n", "'1e999' is not a finite number");
    expectError("0 1 2 3 0 0 0 0\n", "quaternion is null");
    expectError("2 1 2 3 0 0 0 1\n1 1 2 3 0 0 0 1\n", ":2: the time stamp is earlier");
    expectError("2 0 0 0 0 1 0 0 0 0 1 0\n", "not a rotation");
    expectError("-1 0 0 0 0 1 0 0 0 0 1 0\n", "not a rotation");
    EXPECT_THROW(readTrajectory(file_ + ".gone"), std::runtime_error);
    EXPECT_THROW(readTrajectory("/"), std::runtime_error);
}

TEST_F(TrajectoryFile, FailedWriteSaysWhere) {
    const std::string file = "/nonexistent-folder/out.tum";
    try {
        writeTumTrajectory(file, kTrajectory);
        ADD_FAILURE() << "wrote " << file;
    } catch (const std::runtime_error& e) {
        EXPECT_NE(std::string(e.what()).find(file), std::string::npos) << e.what();
    }
}

TEST(PoseAt, InterpolatesBetweenNeighbours) {
    const Trajectory trajectory{{10, makePose({0, 0, 0}, 0.2, {0, 0, 1})},
                                {12, makePose({4, 0, -2}, 1.0, {0, 0, 1})}};
    const auto pose = poseAt(trajectory, 10.5, 0.6);
    ASSERT_TRUE(pose);
    EXPECT_LT(poseDistance(*pose, makePose({1, 0, -0.5}, 0.4, {0, 0, 1})), 1e-12);
    EXPECT_LT(poseDistance(*poseAt(trajectory, 12, 0), trajectory[1].T_world_frame), 1e-12);
    EXPECT_LT(poseDistance(*poseAt(trajectory, 10, 0), trajectory[0].T_world_frame), 1e-12);
}

TEST(PoseAt, IsTheNearestOutsideAndNothingTooFarAway) {
    const Trajectory trajectory{{10, makePose({1, 0, 0}, 0, {0, 0, 1})},
                                {12, makePose({4, 0, 0}, 0, {0, 0, 1})}};
    EXPECT_EQ(poseAt(trajectory, 9.99, 0.02)->t.x(), 1);
    EXPECT_EQ(poseAt(trajectory, 12.01, 0.02)->t.x(), 4);
    EXPECT_FALSE(poseAt(trajectory, 9.9, 0.02));
    EXPECT_FALSE(poseAt(trajectory, 12.1, 0.02));
    EXPECT_FALSE(poseAt(trajectory, 11, 0.9));
    EXPECT_FALSE(poseAt(trajectory, NAN, 1e9));
    EXPECT_FALSE(poseAt({}, 0, 1e9));
}

TEST(PoseAt, EqualStampsAreNoDivisionByZero) {
    const Trajectory trajectory{{1, {}}, {1, {}}, {2, {}}};
    const auto pose = poseAt(trajectory, 1, 0);
    ASSERT_TRUE(pose);
    EXPECT_TRUE(pose->R.allFinite() && pose->t.allFinite());
}

TEST(NearestRotation, RemovesSmallErrorsOnly) {
    const Eigen::Matrix3d R =
        AngleAxisd(1.2, Vector3d(1, 2, -1).normalized()).toRotationMatrix();
    EXPECT_LT((nearestRotation(1.001 * R) - R).cwiseAbs().maxCoeff(), 1e-12);
    EXPECT_THROW(nearestRotation(1.1 * R), std::runtime_error);
    EXPECT_THROW(nearestRotation(-R), std::runtime_error);
    EXPECT_THROW(nearestRotation(Eigen::Matrix3d::Constant(NAN)), std::runtime_error);
}
