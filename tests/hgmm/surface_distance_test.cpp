#include "hgmm/surface_distance.h"

#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <cmath>
#include <limits>
#include <random>
#include <stdexcept>
#include <vector>

#include "hgmm/map.h"
#include "occupancy/nearest_surface.h"
#include "occupancy/patch_tree.h"
#include "planted_mixture.h"
#include "scenes.h"

namespace hgmm {
namespace {

using test::randomCovariance;
using test::uniform;
using testing::emptyRoom;
using testing::mapOf;

constexpr double kAligned_rad = 5 * M_PI / 180.0;

/// Components of all sizes and shapes in a cube of 20 m.
Mixture<3> patchesOfAllSizes(std::size_t n, std::uint64_t seed) {
    std::mt19937_64 engine(seed);
    Mixture<3> mixture;
    for (std::size_t i = 0; i < n; ++i) {
        Gaussian<3> g;
        g.support = uniform(engine, 1, 40);
        for (int d = 0; d < 3; ++d) g.mean[d] = uniform(engine, -10, 10);
        const double size = std::exp(uniform(engine, std::log(0.02), std::log(1.5)));
        g.covariance = size * size * randomCovariance<3>(engine, 200);
        mixture.pushBack(g);
    }
    return mixture;
}

/// By the definition, in double: clamps the point to the rectangle.
template <int D>
double distanceToPatch(const Gaussian<3>& g, const Eigen::Matrix<double, D, 1>& p) {
    const Eigen::Matrix<double, D, D> covariance =
        g.covariance.template topLeftCorner<D, D>();
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix<double, D, D>> solver(covariance);
    Eigen::Matrix<double, D, 1> nearest = g.mean.template head<D>();
    for (int a = 1; a < D; ++a) {
        const Eigen::Matrix<double, D, 1> axis = solver.eigenvectors().col(a);
        const double half = std::sqrt(3.0 * std::max(0.0, solver.eigenvalues()[a]));
        const double along = axis.dot(p - g.mean.template head<D>());
        nearest += std::clamp(along, -half, half) * axis;
    }
    return (p - nearest).norm();
}

template <int D>
void expectBruteForce(const Mixture<3>& mixture, int points, std::uint64_t seed) {
    const PatchTree<D> tree(mixture);
    NearestSurface<D> nearest(tree, 100.0);
    std::mt19937_64 engine(seed);
    for (int k = 0; k < points; ++k) {
        Eigen::Matrix<double, D, 1> p;
        for (int d = 0; d < D; ++d) p[d] = uniform(engine, -14, 14);
        double best = std::numeric_limits<double>::infinity();
        for (std::size_t i = 0; i < mixture.size(); ++i)
            best = std::min(best, distanceToPatch<D>(mixture[i], p));
        const SurfaceDistance answer = nearest(p);
        ASSERT_TRUE(answer.answered());
        ASSERT_NEAR(answer.distance_m, best, 2e-5);
        ASSERT_NEAR(distanceToPatch<D>(mixture[answer.component], p), best, 2e-5);
        EXPECT_EQ(answer.known, mixture.support[answer.component] >= 5);
    }
}

/// The distance of a point in the empty room to its walls, and its gradient.
double distanceToWalls(const testing::Box& room, const Eigen::Vector3d& p,
                       Eigen::Vector3d& gradient) {
    double best = std::numeric_limits<double>::infinity();
    for (int d = 0; d < 3; ++d)
        for (const double side : {1.0, -1.0}) {
            const double away = side > 0 ? p[d] - room.min()[d] : room.max()[d] - p[d];
            if (away >= best) continue;
            best = away;
            gradient = side * Eigen::Vector3d::Unit(d);
        }
    return best;
}

const Map& wholeRoom() {
    static const Map map = mapOf(emptyRoom(), 12);
    return map;
}

std::vector<Eigen::Vector3d> pointsInRoom(std::size_t n, std::uint64_t seed) {
    const testing::Box box = emptyRoom().room;
    std::mt19937_64 engine(seed);
    std::vector<Eigen::Vector3d> points(n);
    for (Eigen::Vector3d& p : points)
        for (int d = 0; d < 3; ++d) p[d] = uniform(engine, box.min()[d], box.max()[d]);
    return points;
}

TEST(SurfaceDistance, IsThatToTheNearestPatch) {
    for (const std::size_t n : {1U, 3U, 4U, 5U, 17U, 600U}) {
        expectBruteForce<3>(patchesOfAllSizes(n, n), 300, 7);
        expectBruteForce<2>(patchesOfAllSizes(n, n), 300, 8);
    }
}

TEST(SurfaceDistance, OfAPatchByHand) {
    Mixture<3> mixture;
    Gaussian<3> g;
    g.support = 20;
    g.mean << 1, 2, 3;
    g.covariance = Eigen::Vector3d(1.0 / 3, 4.0 / 3, 0.0001).asDiagonal();  // 2 x 4 m
    mixture.pushBack(g);
    const PatchTree<3> tree(mixture);
    const auto ask = [&](double x, double y, double z) {
        return NearestSurface<3>(tree, 10.0)({x, y, z});
    };
    EXPECT_NEAR(ask(1.9, 3.9, 3.5).distance_m, 0.5, 1e-6);
    EXPECT_NEAR(ask(1.9, 3.9, 3.5).std_m, 0.01, 1e-6);
    EXPECT_LT((ask(1.9, 3.9, 2.5).gradient + Eigen::Vector3d::UnitZ()).norm(), 1e-6);
    EXPECT_NEAR(ask(5, 7, 3).distance_m, std::hypot(3, 3), 1e-5) << "from the corner";
    EXPECT_LT((ask(5, 7, 3).gradient - Eigen::Vector3d(1, 1, 0).normalized()).norm(), 1e-5);
    EXPECT_EQ(ask(1, 2, 3).distance_m, 0.0);
    EXPECT_EQ(ask(1, 2, 3).gradient, Eigen::Vector3d::Zero()) << "on the patch";
    EXPECT_TRUE(ask(1, 2, 3).known);
}

TEST(SurfaceDistance, EndsAtTheCutOff) {
    const Eigen::Vector3d inside(3.0, 0.2, 1.2);  // 1 m from a wall
    DistanceParams params;
    params.maxDistance_m = 1.1;
    EXPECT_TRUE(wholeRoom().distance(inside, params).known);
    params.maxDistance_m = 0.9;
    for (const Eigen::Vector3d& p :
         {inside, Eigen::Vector3d(1e4, 0, 0), Eigen::Vector3d(-1e30, 1e30, 1e200)}) {
        const SurfaceDistance answer = wholeRoom().distance(p, params);
        EXPECT_FALSE(answer.answered());
        EXPECT_FALSE(answer.known);
        EXPECT_EQ(answer.distance_m, 0.9);
        EXPECT_EQ(answer.gradient, Eigen::Vector3d::Zero());
        EXPECT_EQ(answer.std_m, 0.0);
    }
}

TEST(SurfaceDistance, HasNoAnswerForNanAndEmptyMaps) {
    const double nan = std::nan("");
    EXPECT_FALSE(wholeRoom().distance({0, nan, 1}).answered());
    EXPECT_EQ(wholeRoom().distance({0, nan, 1}).distance_m, DistanceParams{}.maxDistance_m);
    EXPECT_FALSE(wholeRoom().horizontalDistance({nan, 0}).answered());
    EXPECT_FALSE(Map().distance({0, 0, 0}).answered());
    EXPECT_FALSE(Map().distance({0, 0, 0}, {}, 2).answered());
    SurfaceDistance answer;
    Map().distance(nullptr, 0, &answer);
    DistanceParams params;
    for (const double wrong : {0.0, -1.0, nan, 1e9}) {
        params.maxDistance_m = wrong;
        EXPECT_THROW(wholeRoom().distance({0, 0, 0}, params), std::invalid_argument)
            << wrong;
    }
    EXPECT_THROW(wholeRoom().distance({0, 0, 0}, {}, 99), std::out_of_range);
}

TEST(SurfaceDistance, OfARoomIsThatToItsWalls) {
    const testing::Box box = emptyRoom().room;
    double sum = 0;
    std::size_t aligned = 0, beyond = 0;
    const auto points = pointsInRoom(20000, 5);
    for (const Eigen::Vector3d& p : points) {
        Eigen::Vector3d gradient = Eigen::Vector3d::Zero();
        const double truth = distanceToWalls(box, p, gradient);
        const SurfaceDistance answer = wholeRoom().distance(p);
        ASSERT_TRUE(answer.answered());
        sum += std::abs(answer.distance_m - truth);
        if (truth < 0.1) continue;
        ++beyond;
        if (answer.gradient.dot(gradient) > std::cos(kAligned_rad)) ++aligned;
    }
    EXPECT_LT(sum / double(points.size()), 0.01);
    EXPECT_GT(double(aligned), 0.9 * double(beyond));
}

TEST(SurfaceDistance, OfABatchIsThatOfSingleQueries) {
    auto points = pointsInRoom(3000, 6);
    points[1000].x() = std::nan("");
    points[2000] *= 1e6;
    for (const std::size_t level : {0U, 2U}) {
        std::vector<SurfaceDistance> answers(points.size());
        wholeRoom().distance(points.data(), points.size(), answers.data(), {}, level);
        for (std::size_t i = 0; i < points.size(); ++i) {
            const SurfaceDistance one = wholeRoom().distance(points[i], {}, level);
            ASSERT_EQ(one.distance_m, answers[i].distance_m);
            ASSERT_EQ(one.gradient, answers[i].gradient);
            ASSERT_EQ(one.std_m, answers[i].std_m);
            ASSERT_EQ(one.component, answers[i].component);
        }
    }
}

TEST(SurfaceDistance, IsThatOfTheLevel) {
    const Map& map = wholeRoom();
    for (std::size_t level = 0; level < map.levelCount(); ++level) {
        const Mixture<3>& mixture = map.mixture(level);
        for (const Eigen::Vector3d& p : pointsInRoom(20, 9)) {
            double best = std::numeric_limits<double>::infinity();
            for (std::size_t i = 0; i < mixture.size(); ++i)
                best = std::min(best, distanceToPatch<3>(mixture[i], p - map.origin()));
            EXPECT_NEAR(map.distance(p, {}, level).distance_m, best, 2e-5) << level;
        }
    }
}

TEST(SurfaceDistance, FollowsTheMap) {
    Map map = mapOf(emptyRoom(), 2, {}, {1000.0, -2000.0, 0.0});
    const Eigen::Vector3d p = Eigen::Vector3d(1003.0, -2000.0, 1.2);
    const double before = map.distance(p).distance_m;
    EXPECT_NEAR(before, 1.0, 0.02);
    map.forget(testing::Box(Eigen::Vector3d(1003.5, -2010.0, -1.0),
                            Eigen::Vector3d(1010.0, -1990.0, 5.0)));
    EXPECT_GT(map.distance(p).distance_m, before + 0.1);
    map.clear();
    EXPECT_FALSE(map.distance(p).answered());
}

/// Along a segment, distances differ by no more than the way: nowhere is there a step.
TEST(SurfaceDistance, IsContinuous) {
    const PatchTree<3> tree(patchesOfAllSizes(300, 11));
    std::mt19937_64 engine(12);
    for (int k = 0; k < 200; ++k) {
        NearestSurface<3> nearest(tree, 1.5);
        Eigen::Vector3d from, to;
        for (int d = 0; d < 3; ++d) {
            from[d] = uniform(engine, -12, 12);
            to[d] = from[d] + uniform(engine, -1, 1);
        }
        constexpr int steps = 500;
        const double step_m = (to - from).norm() / steps;
        double last = nearest(from).distance_m;
        for (int i = 1; i <= steps; ++i) {
            const double now = nearest(from + (to - from) * i / steps).distance_m;
            ASSERT_LE(std::abs(now - last), step_m + 1e-5);
            last = now;
        }
    }
}

TEST(SurfaceDistance, IsHorizontalForPlanarLasers) {
    const Map& map = wholeRoom();
    const Mixture<3>& mixture = map.mixture();
    for (const Eigen::Vector3d& p : pointsInRoom(20, 10)) {
        double best = std::numeric_limits<double>::infinity();
        const Eigen::Vector2d local = (p - map.origin()).head<2>();
        for (std::size_t i = 0; i < mixture.size(); ++i)
            best = std::min(best, distanceToPatch<2>(mixture[i], local));
        const SurfaceDistance answer = map.horizontalDistance(p.head<2>());
        EXPECT_NEAR(answer.distance_m, best, 2e-5);
        EXPECT_EQ(answer.gradient.z(), 0.0);
    }
}

}  // namespace
}  // namespace hgmm
