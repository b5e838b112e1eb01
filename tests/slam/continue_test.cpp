#include <gtest/gtest.h>
#include <omp.h>

#include <algorithm>
#include <memory>
#include <stdexcept>

#include "hgmm/slam/submap_slam.h"
#include "walk.h"

namespace hgmm::slam {
namespace {

using namespace testing;

/// The corridor of ringCorridor() with other pillars: what another building looks like.
Scene anotherCorridor() {
    return ringCorridorWith({{-2.4, -4.7},
                             {3.1, -5.0},
                             {6.6, -5.6},
                             {4.8, 1.4},
                             {7.0, 3.1},
                             {1.2, 4.9},
                             {-5.4, 5.7},
                             {-7.0, -0.3}});
}

/// A walk without drift, finished.
std::unique_ptr<SubmapSlam> walked(const Scene& scene, const std::vector<Pose>& truth,
                                   double bias_rad = 0.0) {
    auto slam = std::make_unique<SubmapSlam>();
    std::mt19937_64 random(7);
    for (std::size_t i = 0; i < truth.size(); ++i) {
        UncertainPose motion;
        if (i > 0) motion = drifting(truth[i - 1].inverse() * truth[i], bias_rad, random);
        slam->add(samplesAt(scene, truth[i], i), {}, motion);
    }
    slam->finish();
    return slam;
}

std::vector<Pose> part(const std::vector<Pose>& poses, double from, double to) {
    const auto at = [&](double share) {
        return poses.begin() + std::ptrdiff_t(share * double(poses.size()));
    };
    return {at(from), at(to)};
}

/// A robot that turned round, so that neither place nor heading is that of the first start.
std::vector<Pose> theOtherWay(std::vector<Pose> poses) {
    std::reverse(poses.begin(), poses.end());
    for (Pose& pose : poses) pose.R = pose.R * rotationOf({0, 0, M_PI});
    return poses;
}

double worstOff(const std::vector<Pose>& poses, const std::vector<Pose>& truth,
                const Pose& T_map_world) {
    double worst = poses.size() == truth.size() ? 0.0 : 1e9;
    for (std::size_t i = 0; i < std::min(poses.size(), truth.size()); ++i)
        worst = std::max(worst, (poses[i].t - (T_map_world * truth[i]).t).norm());
    return worst;
}

TEST(Continue, ASecondSessionLiesInTheFrameOfTheFirst) {
    const Scene scene = ringCorridor();
    const std::vector<Pose> lap = walkAround(0.25, 1.0);
    const std::vector<Pose> first = part(lap, 0.0, 0.6);
    const std::vector<Pose> second = theOtherWay(part(lap, 0.2, 0.9));
    const auto earlier = std::make_shared<const Map>(walked(scene, first)->fusedMap());
    const Pose T_map_world = first[0].inverse();

    const auto slam = walked(scene, second, 3e-4);
    ASSERT_GT(worstOff(slam->trajectory(), second, T_map_world), 3.0);
    const std::size_t submaps = slam->submaps();
    const Continuation continuation = slam->continueFrom(earlier);
    ASSERT_TRUE(continuation.found)
        << continuation.agreeing << ", elsewhere " << continuation.elsewhere;
    EXPECT_LT(worstOff(slam->trajectory(), second, T_map_world), 0.35);
    EXPECT_EQ(slam->submaps(), submaps);
    EXPECT_EQ(slam->parts(), 1U);
    EXPECT_EQ(slam->graph().T_world_node.size(), submaps + 1);

    // What only the first saw, what only the second saw, and what both saw.
    const Map map = slam->fusedMap();
    const auto at = [&](double x, double y) {
        return map.occupancy(T_map_world.R * Eigen::Vector3d(x, y, 0) + T_map_world.t);
    };
    EXPECT_GT(at(-4.0, -7.8).occupied, 0.5F);
    EXPECT_GT(at(-4.0, -6.0).free, 0.5F);
    EXPECT_GT(at(-7.8, 2.0).occupied, 0.5F);
    EXPECT_GT(at(-6.0, 2.0).free, 0.5F);
    const Eigen::Vector3d both = T_map_world.R * Eigen::Vector3d(7.8, 2, 0) + T_map_world.t;
    EXPECT_LT(map.distance(both).distance_m, 0.15);
    EXPECT_GT(at(6.0, 2.0).free, 0.5F);
}

TEST(Continue, AnotherBuildingIsNotTakenForTheFirst) {
    const std::vector<Pose> lap = walkAround(0.25, 1.0);
    const auto earlier =
        std::make_shared<const Map>(walked(ringCorridor(), part(lap, 0, 0.8))->fusedMap());
    const auto slam = walked(anotherCorridor(), part(lap, 0, 0.8));
    const std::vector<Pose> before = slam->trajectory();
    const Map mapBefore = slam->fusedMap();
    EXPECT_FALSE(slam->continueFrom(earlier).found);
    EXPECT_EQ(slam->graph().T_world_node.size(), slam->submaps());
    const std::vector<Pose> after = slam->trajectory();
    for (std::size_t i = 0; i < before.size(); ++i) EXPECT_EQ(before[i].t, after[i].t);
    EXPECT_EQ(mapBefore, slam->fusedMap());
}

/// A single place proves little: a submap of a kitchen was found in a building.
TEST(Continue, ASingleSubmapIsNotBelieved) {
    const Scene scene = ringCorridor();
    const std::vector<Pose> lap = walkAround(0.25, 1.0);
    const auto earlier =
        std::make_shared<const Map>(walked(scene, part(lap, 0, 0.3))->fusedMap());
    const auto slam = walked(scene, part(lap, 0.1, 0.13));
    ASSERT_EQ(slam->submaps(), 1U);
    const Continuation continuation = slam->continueFrom(earlier);
    EXPECT_EQ(continuation.agreeing, 1U);
    EXPECT_FALSE(continuation.found);
}

/// Four sides that look alike, without any pillar.
TEST(Continue, ABuildingThatRepeatsItselfIsRefused) {
    const Scene scene = ringCorridorWith({});
    const std::vector<Pose> lap = walkAround(0.25, 1.0);
    const auto earlier = std::make_shared<const Map>(walked(scene, lap)->fusedMap());
    const Continuation continuation =
        walked(scene, part(lap, 0.1, 0.5))->continueFrom(earlier);
    EXPECT_FALSE(continuation.found) << continuation.agreeing;
    EXPECT_GT(continuation.elsewhere, 0U);
}

TEST(Continue, IsTheSameForAnyNumberOfThreads) {
    const Scene scene = ringCorridor();
    const std::vector<Pose> lap = walkAround(0.5, 1.0);
    const auto earlier =
        std::make_shared<const Map>(walked(scene, part(lap, 0, 0.6))->fusedMap());
    const int threads = omp_get_max_threads();
    std::vector<Pose> one, three;
    for (const auto& [count, poses] : {std::pair{1, &one}, {3, &three}}) {
        omp_set_num_threads(count);
        const auto slam = walked(scene, part(lap, 0.2, 0.7));
        EXPECT_TRUE(slam->continueFrom(earlier).found);
        *poses = slam->trajectory();
    }
    omp_set_num_threads(threads);
    ASSERT_EQ(one.size(), three.size());
    for (std::size_t i = 0; i < one.size(); ++i) {
        EXPECT_EQ(one[i].R, three[i].R) << i;
        EXPECT_EQ(one[i].t, three[i].t) << i;
    }
}

/// Submap of what a lidar sees along poses, in a frame that is tilted against the first.
FinishedSubmap tiltedSubmap(const Scene& scene, const std::vector<Pose>& truth,
                            const Pose& T_submap_first) {
    const SimulatedSensor lidar = evaluation::ringLidar(32, -30.0, 20.0, 360, 30.0);
    Submap submap{MapParams{}};
    for (std::size_t i = 0; i < truth.size(); ++i) {
        const Pose T = T_submap_first * truth[0].inverse() * truth[i];
        const auto returns =
            evaluation::simulateReturns(scene, lidar, truth[i], {0.01, 0.0, 0.3}, 3, i);
        submap.map.insert(samplesOf(evaluation::scanOf(returns, lidar, Pose{},
                                                       evaluation::WithoutReturn::leftOut),
                                    MapParams{}),
                          T);
        submap.T_submap_robot.push_back(T);
    }
    return FinishedSubmap(std::move(submap));
}

TEST(Continue, FindsASessionWhoseFrameIsTilted) {
    Scene scene = ringCorridor();
    scene.add(evaluation::Box{{-8, -8, -1.2}, {8, 8, -1.0}}, Part::floor);
    const std::vector<Pose> lap = walkAround(0.4, 1.0);
    const FinishedSubmap first = tiltedSubmap(scene, part(lap, 0.0, 0.3), {});
    const Pose tilt{rotationOf({0.25, 0.15, 0}), Eigen::Vector3d::Zero()};
    const std::vector<Pose> second = theOtherWay(part(lap, 0.1, 0.2));
    const FinishedSubmap submap = tiltedSubmap(scene, second, tilt);
    const Pose truth = lap[0].inverse() * second[0] * tilt.inverse();
    const EarlierMap earlier(std::make_shared<const Map>(first.submap.map));
    double nearest_m = 1e9, nearest_rad = 1e9;
    for (const UncertainPose& place : earlier.placesOf(submap, {})) {
        const Vector6d error = errorOf(place.T_a_b, truth);
        nearest_m = std::min(nearest_m, error.tail<3>().norm());
        nearest_rad = std::min(nearest_rad, error.head<3>().norm());
    }
    EXPECT_LT(nearest_m, 0.1);
    EXPECT_LT(nearest_rad, 0.02);
}

TEST(Continue, RefusesWhatIsNoMapAndWhatIsNotFinished) {
    SubmapSlam slam;
    EXPECT_THROW(slam.continueFrom(nullptr), std::invalid_argument);
    EXPECT_THROW(slam.continueFrom(std::make_shared<const Map>()), std::invalid_argument);
    const Scene scene = ringCorridor();
    const auto earlier =
        std::make_shared<const Map>(walked(scene, walkAround(0.5, 0.2))->fusedMap());
    slam.add(samplesAt(scene, walkAround(0.5, 0.1)[0], 0), {}, {});
    EXPECT_THROW(slam.continueFrom(earlier), std::logic_error);
    SubmapSlam nothing;
    nothing.finish();
    EXPECT_FALSE(nothing.continueFrom(earlier).found);
}

}  // namespace
}  // namespace hgmm::slam
