#include "hgmm/slam/submap_slam.h"

#include <gtest/gtest.h>
#include <omp.h>

#include <limits>

#include "walk.h"

namespace hgmm::slam {
namespace {

using namespace testing;

struct Walked {
    std::vector<Pose> odometry;    // composed
    std::vector<Pose> trajectory;  // by SLAM
    std::size_t closures = 0;
};

Walked walk(const std::vector<Pose>& truth, double bias_rad, const Scene& scene) {
    SubmapSlam slam;
    std::mt19937_64 random(5);
    Walked walked;
    Pose composed;
    for (std::size_t i = 0; i < truth.size(); ++i) {
        UncertainPose motion;
        if (i > 0) motion = drifting(truth[i - 1].inverse() * truth[i], bias_rad, random);
        composed = composed * motion.T_a_b;
        walked.odometry.push_back(composed);
        slam.add(samplesAt(scene, truth[i], i), {}, motion);
    }
    slam.finish();
    walked.trajectory = slam.trajectory();
    walked.closures = slam.closures();
    return walked;
}

double worstError(const std::vector<Pose>& poses, const std::vector<Pose>& truth) {
    double worst = 0;
    for (std::size_t i = 0; i < truth.size(); ++i)
        worst = std::max(worst, (poses[i].t - (truth[0].inverse() * truth[i]).t).norm());
    return worst;
}

TEST(SubmapSlam, ClosesALoopThatOdometryLeavesOpen) {
    const std::vector<Pose> truth = walkAround(0.25, 1.2);
    const Walked walked = walk(truth, 6e-4, ringCorridor());
    ASSERT_EQ(walked.trajectory.size(), truth.size());
    EXPECT_GT(worstError(walked.odometry, truth), 0.8);
    EXPECT_GE(walked.closures, 1U);
    EXPECT_LT(worstError(walked.trajectory, truth), 0.3);
}

TEST(SubmapSlam, IsTheSameForAnyNumberOfThreads) {
    const std::vector<Pose> truth = walkAround(0.5, 1.1);
    const Scene scene = ringCorridor();
    const int threads = omp_get_max_threads();
    omp_set_num_threads(1);
    const Walked one = walk(truth, 6e-4, scene);
    omp_set_num_threads(3);
    const Walked three = walk(truth, 6e-4, scene);
    omp_set_num_threads(threads);
    ASSERT_EQ(one.trajectory.size(), three.trajectory.size());
    for (std::size_t i = 0; i < one.trajectory.size(); ++i) {
        EXPECT_EQ(one.trajectory[i].R, three.trajectory[i].R) << i;
        EXPECT_EQ(one.trajectory[i].t, three.trajectory[i].t) << i;
    }
}

TEST(SubmapSlam, FusedMapKnowsTheWalls) {
    const std::vector<Pose> truth = walkAround(0.5, 0.3);
    const Scene scene = ringCorridor();
    SubmapSlam slam;
    for (std::size_t i = 0; i < truth.size(); ++i) {
        UncertainPose motion;
        if (i > 0) motion.T_a_b = truth[i - 1].inverse() * truth[i];
        slam.add(samplesAt(scene, truth[i], i), {}, motion);
    }
    slam.finish();
    ASSERT_GT(slam.submaps(), 1U);
    const Map map = slam.fusedMap();
    const auto at = [&](double x, double y) {
        const Pose T_map_world = truth[0].inverse();
        return map.occupancy(T_map_world.R * Eigen::Vector3d(x, y, 0) + T_map_world.t);
    };
    for (const double x : {-5.0, -2.0, 0.0, 3.0, 4.5}) {
        EXPECT_GT(at(x, -7.8).occupied, 0.5F) << x;
        EXPECT_GT(at(x, -6.0).free, 0.5F) << x;
    }
}

TEST(SubmapSlam, OfNothingIsEmpty) {
    SubmapSlam slam;
    slam.finish();
    EXPECT_TRUE(slam.trajectory().empty());
    EXPECT_TRUE(slam.fusedMap().empty());
    EXPECT_EQ(slam.submaps(), 0U);
}

TEST(SubmapSlam, ScansWithoutPointsHavePosesAllTheSame) {
    SubmapSlam slam;
    UncertainPose ahead;
    ahead.T_a_b.t.x() = 0.4;
    for (int i = 0; i < 30; ++i) slam.add({}, {}, ahead);
    slam.finish();
    ASSERT_EQ(slam.trajectory().size(), 30U);
    EXPECT_NEAR(slam.trajectory().back().t.x(), 29 * 0.4, 1e-9);
    EXPECT_EQ(slam.closures(), 0U);
}

UncertainPose steps(int count) {
    UncertainPose motion;
    motion.T_a_b.t.x() = 0.25 * count;
    return motion;
}

TEST(SubmapSlam, LostScansHavePosesAndLeaveTheMapAsItIs) {
    const std::vector<Pose> truth = walkAround(0.25, 0.1);
    const Scene scene = ringCorridor();
    SubmapSlam with, without;
    UncertainPose aside;
    aside.T_a_b.t = {0.1, 0.2, 0};
    for (std::size_t i = 0; i < truth.size(); ++i) {
        const ScanSamples scan = samplesAt(scene, truth[i], i);
        with.add(scan, {}, steps(1));
        without.add(scan, {}, steps(1));
        if (i == 7) with.addLost(aside);
    }
    with.finish();
    without.finish();
    const std::vector<Pose> poses = with.trajectory();
    ASSERT_EQ(poses.size(), truth.size() + 1);
    EXPECT_LT((poses[8].t - poses[7].t - aside.T_a_b.t).norm(), 1e-5);
    EXPECT_LT((poses.back().t - without.trajectory().back().t).norm(), 1e-9);
    EXPECT_EQ(with.fusedMap(), without.fusedMap());
    EXPECT_EQ(with.parts(), 1U);
}

TEST(SubmapSlam, AGuessBeginsASubmapAndLeavesTwoParts) {
    const std::vector<Pose> truth = walkAround(0.25, 0.1);
    const Scene scene = ringCorridor();
    SubmapSlam slam;
    slam.add(samplesAt(scene, truth[0], 0), {}, {});
    slam.add(samplesAt(scene, truth[1], 1), {}, steps(1));
    EXPECT_EQ(slam.submaps(), 1U);
    UncertainPose guess = steps(1);
    guess.covariance.diagonal().setConstant(1.0);
    slam.add(samplesAt(scene, truth[2], 2), {}, guess);
    EXPECT_EQ(slam.submaps(), 2U);
    EXPECT_EQ(slam.parts(), 2U);
}

TEST(SubmapSlam, RefusesScansAfterTheEnd) {
    SubmapSlam slam;
    slam.add({}, {}, {});
    slam.finish();
    slam.finish();
    EXPECT_THROW(slam.add({}, {}, {}), std::logic_error);
    EXPECT_THROW(slam.addLost({}), std::logic_error);
    EXPECT_EQ(slam.trajectory().size(), 1U);
}

TEST(SubmapSlam, RefusesParametersThatAreOutOfRange) {
    SlamParams params;
    params.submap.minLength_m = 0;
    EXPECT_THROW(SubmapSlam({}, params), std::invalid_argument);
    params = {};
    params.optimisation.kernelWidth = std::numeric_limits<double>::quiet_NaN();
    EXPECT_THROW(SubmapSlam({}, params), std::invalid_argument);
}

TEST(SubmapSlam, RefusesPosesThatAreNone) {
    SubmapSlam slam;
    UncertainPose broken;
    slam.add({}, {}, broken);
    broken.T_a_b.R *= 2;
    EXPECT_THROW(slam.add({}, {}, broken), std::invalid_argument);
    EXPECT_EQ(slam.trajectory().size(), 1U);
}

}  // namespace
}  // namespace hgmm::slam
