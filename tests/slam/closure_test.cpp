#include "hgmm/slam/closure.h"

#include <gtest/gtest.h>

#include "closure_pool.h"
#include "walk.h"

namespace hgmm::slam {
namespace {

using namespace testing;

/// What is seen along a few true poses, in the frame of the first.
FinishedSubmap submapOf(const Scene& scene, const std::vector<Pose>& truth) {
    Submap submap{MapParams{}};
    for (std::size_t i = 0; i < truth.size(); ++i) {
        submap.T_submap_robot.push_back(truth[0].inverse() * truth[i]);
        submap.map.insert(samplesAt(scene, truth[i], i), submap.T_submap_robot.back());
    }
    return FinishedSubmap(std::move(submap));
}

std::vector<Pose> posesAlong(double x0, double x1, double y, double yaw_rad) {
    std::vector<Pose> poses;
    for (int k = 0; k < 6; ++k)
        poses.push_back({rotationOf({0, 0, yaw_rad}), {x0 + (x1 - x0) * k / 5.0, y, 0}});
    return poses;
}

UncertainPose guess(const Pose& pose, double off_m, double off_rad, double sigma_m,
                    double sigma_rad) {
    Vector6d error;
    error << 0, 0, off_rad, off_m, -off_m, 0;
    UncertainPose guessed{displacedBy(pose, error), Matrix6d::Zero()};
    guessed.covariance.diagonal() << 1e-6, 1e-6, sigma_rad * sigma_rad, sigma_m * sigma_m,
        sigma_m * sigma_m, 1e-6;
    return guessed;
}

TEST(Closure, FindsThePoseOfASubmapSeenTheOtherWay) {
    const Scene scene = ringCorridor();
    const auto there = posesAlong(-6, -1, -6, 0.0), back = posesAlong(0, -5, -6.2, M_PI);
    const FinishedSubmap target = submapOf(scene, there), source = submapOf(scene, back);
    const Pose truth = there[0].inverse() * back[0];
    const auto found =
        verifiedPose(target, source, guess(truth, 1.0, 0.3, 1.2, 0.4), ClosureParams{});
    ASSERT_TRUE(found);
    const Vector6d error = errorOf(found->T_a_b, truth);
    EXPECT_LT(error.tail<3>().norm(), 0.05);
    EXPECT_LT(error.head<3>().norm(), 0.01);
    EXPECT_LT(squaredMahalanobis(error, found->covariance), kChiSquareOfSix);
}

TEST(Closure, RefusesAPlaceThatIsAnotherOne) {
    const Scene scene = ringCorridor();
    const auto south = posesAlong(-6, -1, -6, 0.0);
    std::vector<Pose> north = posesAlong(6, 1, 6, M_PI);
    const FinishedSubmap target = submapOf(scene, south), source = submapOf(scene, north);
    // As if drift had laid one side of the corridor over the other.
    EXPECT_FALSE(verifiedPose(target, source, guess({}, 0.0, 0.0, 1.0, 0.2), {}));
}

/// A room of 8 x 6 m with eight things in it, like others but for where these are.
Scene furnishedRoom(std::mt19937_64& random) {
    Scene scene;
    for (const auto& [low, high] :
         {std::pair{Eigen::Vector3d(-4, -3, -1), Eigen::Vector3d(4, -2.8, 2)},
          {Eigen::Vector3d(-4, 2.8, -1), Eigen::Vector3d(4, 3, 2)},
          {Eigen::Vector3d(-4, -3, -1), Eigen::Vector3d(-3.8, 3, 2)},
          {Eigen::Vector3d(3.8, -3, -1), Eigen::Vector3d(4, 3, 2)}})
        scene.add(evaluation::Box{low, high}, Part::wall);
    std::uniform_real_distribution<double> along(-3.3, 3.3), width(0.15, 0.4);
    for (int k = 0; k < 8; ++k) {
        const double side = k % 2 == 0 ? 1.0 : -1.0;  // the middle is where the robot goes
        const Eigen::Vector3d at(along(random), side * (1.6 + 0.3 * width(random)), -1);
        const double half = width(random);
        scene.add(evaluation::Box{at - Eigen::Vector3d(half, half, 0),
                                  at + Eigen::Vector3d(half, half, 3)},
                  Part::pole);
    }
    return scene;
}

/// How many of some pairs of rooms that look alike are taken for one.
int mistaken(int pairs) {
    std::mt19937_64 random(11);
    int count = 0;
    for (int k = 0; k < pairs; ++k) {
        const FinishedSubmap target =
            submapOf(furnishedRoom(random), posesAlong(-2, 2, 0.3, 0.0));
        const FinishedSubmap source =
            submapOf(furnishedRoom(random), posesAlong(-2, 2, -0.2, 0.0));
        count += verifiedPose(target, source, guess({}, 0.0, 0.0, 1.0, 0.3), {}) ? 1 : 0;
    }
    return count;
}

TEST(Closure, RoomsThatLookAlikeAreNotTakenForOne) {
    EXPECT_EQ(mistaken(12), 0);
}

TEST(Closure, AgreementTellsFoundFromContradictedAndUnseen) {
    const Scene scene = ringCorridor();
    const FinishedSubmap submap = submapOf(scene, posesAlong(-6, -1, -6, 0.0));
    const Mixture<3>& surfaces = submap.shape.surfaces_submap;
    const Agreement same = agreementOf(submap.submap.map, surfaces, {});
    EXPECT_GT(same.overlap, 0.97);
    EXPECT_GT(same.explained, 0.97);
    EXPECT_LT(same.contradicted, 0.01);
    Pose shifted;
    shifted.t.y() = 1.0;  // walls in the middle of the corridor
    EXPECT_GT(agreementOf(submap.submap.map, surfaces, shifted).contradicted, 0.2);
    shifted.t.y() = 100.0;
    EXPECT_EQ(agreementOf(submap.submap.map, surfaces, shifted).overlap, 0.0);
}

TEST(Closure, AgreementCountsSurfacesByTheirSize) {
    const Scene scene = ringCorridor();
    const FinishedSubmap submap = submapOf(scene, posesAlong(-6, -1, -6, 0.0));
    Mixture<3> wallAndPost;
    // A wall of 12 m in free space, and one thing of .1 m that is there.
    Gaussian<3> component;
    component.mean = Eigen::Vector3d(3, 0, 0);
    component.covariance = Eigen::Vector3d(12.0, 1e-4, 1e-4).asDiagonal();
    component.support = 100;
    wallAndPost.pushBack(component);
    const Mixture<3>& known = submap.shape.surfaces_submap;
    component.mean = known[0].mean;
    component.covariance = Eigen::Vector3d(1e-4, 1e-4, 1e-4).asDiagonal();
    wallAndPost.pushBack(component);
    const Agreement agreement = agreementOf(submap.submap.map, wallAndPost, {});
    EXPECT_LT(agreement.overlap, 0.3);
    EXPECT_GT(agreement.contradicted, 0.5);
    EXPECT_LT(agreement.contradictedComponents, agreement.contradicted);
}

TEST(Closure, SmallThingsWhereTheOtherSawNoneTellByTheirNumber) {
    const FinishedSubmap submap = submapOf(ringCorridor(), posesAlong(-6, -1, -6, 0.0));
    Mixture<3> withPosts = submap.shape.surfaces_submap;
    const std::size_t posts = withPosts.size() / 4;
    for (std::size_t k = 0; k < posts; ++k) {
        Gaussian<3> post;
        post.support = 100;
        post.mean = Eigen::Vector3d(0.5 + 3.0 * double(k) / double(posts), 0, 0);
        post.covariance = Eigen::Vector3d(1e-4, 1e-4, 1e-4).asDiagonal();
        withPosts.pushBack(post);
    }
    const Agreement agreement = agreementOf(submap.submap.map, withPosts, {});
    EXPECT_LT(agreement.contradicted, 0.06);
    EXPECT_GT(agreement.contradictedComponents, 0.1);
}

TEST(Closure, AGraphThatIsSureOfWhatCannotBeIsContradicted) {
    std::mt19937_64 random(3);
    const Scene room = furnishedRoom(random), other = furnishedRoom(random);
    const auto there = posesAlong(-2, 2, 0.3, 0.0), back = posesAlong(-2, 2, -0.2, 0.0);
    const FinishedSubmap target = submapOf(room, there), same = submapOf(room, back),
                         elsewhere = submapOf(other, back);
    const Pose truth = there[0].inverse() * back[0];
    EXPECT_FALSE(contradicts(target, same, guess(truth, 0, 0, 0.05, 0.01)));
    Pose acrossTheRoom = truth;
    acrossTheRoom.t += Eigen::Vector3d(2.0, 1.5, 0);
    EXPECT_TRUE(contradicts(target, elsewhere, guess(acrossTheRoom, 0, 0, 0.05, 0.01)));
    EXPECT_FALSE(contradicts(target, elsewhere, guess(acrossTheRoom, 0, 0, 2.0, 0.01)));
}

TEST(Closure, AppearanceDoesNotChangeWithYawButWithThePlace) {
    const Scene scene = ringCorridor();
    const FinishedSubmap a = submapOf(scene, posesAlong(-6, -1, -6, 0.0));
    const FinishedSubmap turned = submapOf(scene, posesAlong(-6, -1, -6, 2.0));
    Mixture<3> rotated = transformed(a.shape.surfaces_submap,
                                     {rotationOf({0, 0, 2.0}), Eigen::Vector3d::Zero()});
    const Appearance same(rotated, Eigen::Vector3d::Zero());
    EXPECT_GT(a.shape.appearance.similarity(same), 0.995);
    Scene hall;
    hall.add(evaluation::Box{{9, -20, -1}, {9.2, 20, 2}}, Part::wall);
    for (int k = 0; k < 12; ++k)
        hall.add(evaluation::Pillar{{-5 + k, 3.0 + 0.3 * k}, 0.15, -1, 2}, Part::pole);
    const FinishedSubmap other = submapOf(hall, posesAlong(-1, 1, 0, 0.0));
    EXPECT_LT(a.shape.appearance.similarity(other.shape.appearance),
              a.shape.appearance.similarity(turned.shape.appearance));
}

/// A straight graph, and closures between its nodes that are off by `shift_m`.
struct Straight {
    explicit Straight(std::size_t nodes) {
        Matrix6d covariance = Matrix6d::Identity() * 1e-6;
        for (std::size_t k = 0; k < nodes; ++k) {
            Pose pose;
            pose.t.x() = static_cast<double>(k);
            graph.T_world_node.push_back(pose);
            Pose step;
            step.t.x() = 1.0;
            if (k > 0) graph.edges.push_back({k - 1, k, {step, covariance}, {}});
        }
    }
    PoseEdge closure(std::size_t from, std::size_t to, double shift_m) const {
        Pose pose = graph.T_world_node[from].inverse() * graph.T_world_node[to];
        pose.t.y() += shift_m;
        return {from, to, {pose, Matrix6d::Identity() * 1e-4}, PoseEdge::Kind::closure};
    }
    PoseGraph graph;
};

TEST(Closure, TheLargestConsistentSetIsFound) {
    const Straight line(30);
    const std::vector<PoseEdge> closures = {
        line.closure(0, 20, 2.0),  line.closure(1, 21, -3.0), line.closure(2, 22, 2.01),
        line.closure(3, 23, 1.99), line.closure(4, 24, 5.0),  line.closure(5, 25, -3.0)};
    EXPECT_EQ(consistentClosures(line.graph, closures),
              (std::vector<std::size_t>{0, 2, 3}));
}

/// A part of ten nodes, a guess, and another part of ten.
Straight twoParts() {
    Straight line(20);
    doubtOdometryTo(10, line.graph);
    return line;
}

TEST(ClosurePool, PartsAreJoinedByWhatIsFoundAtThreePlaces) {
    Straight line = twoParts();
    ASSERT_EQ(partsOf(line.graph), 2U);
    ClosurePool pool({});
    EXPECT_EQ(pool.enter({line.closure(1, 15, 0.2)}, line.graph), 0U);
    // One place that is like three others, which agree with each other.
    EXPECT_EQ(pool.enter({line.closure(3, 15, 0.2), line.closure(5, 15, 0.2)}, line.graph),
              0U);
    EXPECT_EQ(pool.enter({line.closure(3, 16, 0.2)}, line.graph), 0U);
    EXPECT_EQ(pool.enter({line.closure(3, 17, 0.2)}, line.graph), 5U);
    EXPECT_EQ(partsOf(line.graph), 1U);
}

TEST(ClosurePool, AClosureThatAgreesWithASureGraphEntersAtOnce) {
    Straight line(20);
    ClosurePool pool({});
    EXPECT_EQ(pool.enter({line.closure(1, 15, 0.01)}, line.graph), 1U);
    EXPECT_EQ(pool.enter({line.closure(1, 15, 5.0)}, line.graph), 0U);
}

TEST(Closure, DisagreementCountsClosureAndGraph) {
    const Straight line(2);
    // Variances 1e-6 and 1e-4 along y.
    EXPECT_NEAR(disagreementWith(line.graph, line.closure(0, 1, 0.02)), 4e-4 / 1.01e-4,
                1e-3);
}

}  // namespace
}  // namespace hgmm::slam
