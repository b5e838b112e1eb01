#include <gtest/gtest.h>
#include <hgmm/evaluation/planar_observation.h>
#include <hgmm/mrpt_bridge/mrpt_compat.h>
#include <hgmm/mrpt_bridge/observation_to_scan.h>
#include <mrpt/obs/CActionRobotMovement2D.h>
#include <mrpt/poses/CPosePDFGaussian.h>
#include <mrpt/slam/CMetricMapBuilderHGMM.h>

#include <stdexcept>

#include "walk.h"

namespace hgmm::slam {
namespace {

using namespace testing;
using mrpt::slam::CMetricMapBuilderHGMM;

mrpt::obs::CSensoryFrame frameFrom(const Pose& truth, std::size_t index) {
    static const Scene scene = ringCorridor();
    auto observation =
        mrpt::obs::CObservation2DRangeScan::Create(evaluation::planarObservation(
            evaluation::simulateReturns(scene, laser(), truth, {0.01, 0.0, 0.3}, 3, index),
            laser(), 270.0, evaluation::NoReturn::invalidZero));
    observation->timestamp = mrpt::Clock::fromDouble(1000.0 + 0.1 * double(index));
    mrpt::obs::CSensoryFrame frame;
    frame.insert(observation);
    return frame;
}

/// Follows a walk without odometry.
void follow(mrpt::slam::CMetricMapBuilder& builder, const std::vector<Pose>& truth) {
    for (std::size_t i = 0; i < truth.size(); ++i) {
        mrpt::obs::CActionCollection none;
        mrpt::obs::CSensoryFrame frame = frameFrom(truth[i], i);
        builder.processActionObservation(none, frame);
    }
}

TEST(MetricMapBuilder, BuildsAMapFromItsStartOn) {
    const std::vector<Pose> truth = walkAround(0.1, 0.1);
    CMetricMapBuilderHGMM builder;
    const mrpt::poses::CPosePDFGaussian start(
        mrpt::poses::CPose2D(mrpt_bridge::toCPose3D(truth[0])));
    builder.initialize({}, &start);
    follow(builder, truth);
    EXPECT_FALSE(builder.isLost());
    mrpt::poses::CPose3D found;
    builder.getCurrentPoseEstimation()->getMean(found);
    EXPECT_LT((mrpt_bridge::toPose(found).t - truth.back().t).norm(), 0.1);

    mrpt::maps::CSimpleMap keyframes;
    builder.getCurrentlyBuiltMap(keyframes);
    EXPECT_GT(keyframes.size(), 10U);
    EXPECT_EQ(keyframes.size(), builder.getCurrentlyBuiltMapSize());

    const auto& maps = mrpt_bridge::referenceTo(builder.getCurrentlyBuiltMetricMap());
    ASSERT_EQ(maps.maps.size(), 1U);
    const auto& map = dynamic_cast<const mrpt::maps::CHGMMOccupancyMap&>(*maps.maps[0]);
    EXPECT_GT(map.model().occupancy({-4.0, -7.8, 0}).occupied, 0.5F);
    EXPECT_GT(map.model().occupancy({-4.0, -6.0, 0}).free, 0.5F);
}

TEST(MetricMapBuilder, WithoutUpdatingTheMapStays) {
    const std::vector<Pose> truth = walkAround(0.1, 0.06);
    const std::vector<Pose> first(truth.begin(), truth.begin() + 10);
    CMetricMapBuilderHGMM builder;
    follow(builder, first);
    const unsigned size = builder.getCurrentlyBuiltMapSize();
    builder.enableMapUpdating(false);
    for (std::size_t i = first.size(); i < truth.size(); ++i) {
        mrpt::obs::CActionCollection none;
        mrpt::obs::CSensoryFrame frame = frameFrom(truth[i], i);
        builder.processActionObservation(none, frame);
    }
    EXPECT_EQ(builder.getCurrentlyBuiltMapSize(), size);
    mrpt::poses::CPose3D found;
    builder.getCurrentPoseEstimation()->getMean(found);
    EXPECT_LT((mrpt_bridge::toPose(found).t - (truth[0].inverse() * truth.back()).t).norm(),
              0.1);
}

TEST(MetricMapBuilder, FollowsMovementsWhereNothingIsSeen) {
    CMetricMapBuilderHGMM builder;
    const std::vector<Pose> truth = walkAround(0.1, 0.02);
    follow(builder, truth);
    mrpt::obs::CActionRobotMovement2D movement;
    movement.computeFromOdometry(mrpt::poses::CPose2D(0.1, 0, 0), {});
    mrpt::obs::CActionCollection action;
    action.insert(movement);
    mrpt::obs::CSensoryFrame nothing;
    builder.processActionObservation(action, nothing);
    mrpt::obs::CSensoryFrame frame = frameFrom(walkAround(0.1, 0.03)[truth.size() + 1], 99);
    builder.processActionObservation(action, frame);
    EXPECT_FALSE(builder.isLost());
}

TEST(MetricMapBuilder, DoesNotGoOnFromAMap) {
    CMetricMapBuilderHGMM builder;
    follow(builder, walkAround(0.1, 0.01));
    mrpt::maps::CSimpleMap keyframes;
    builder.getCurrentlyBuiltMap(keyframes);
    EXPECT_THROW(builder.initialize(keyframes), std::invalid_argument);
    builder.initialize();
    EXPECT_EQ(builder.getCurrentlyBuiltMapSize(), 0U);
}

}  // namespace
}  // namespace hgmm::slam
