#include "hgmm/collision.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <stdexcept>
#include <vector>

#include "hgmm/map.h"
#include "occupancy/body_gap.h"
#include "occupancy/surface_patch.h"
#include "planted_mixture.h"
#include "scenes.h"

namespace hgmm {
namespace {

using test::normal;
using test::randomCovariance;
using test::uniform;

constexpr double kGrid_m = 0.01;

const Map& roomWithAChest() {
    static const Map map = testing::mapOf(
        testing::roomWith({Eigen::Vector3d(1, 1, 0), Eigen::Vector3d(2, 2, 1)}), 6);
    return map;
}

/// Points of all patches of a map, 1 cm apart, the corners among them, in the map frame.
std::vector<Eigen::Vector3d> patchPoints(const Map& map) {
    std::vector<Eigen::Vector3d> points;
    for (std::uint32_t i = 0; i < map.mixture().size(); ++i) {
        const SurfacePatch<3> patch = *patchOf<3>(map.mixture(), i);
        int count[3] = {1, 1, 1};
        for (int a = 1; a < 3; ++a)
            count[a] = 1 + static_cast<int>(std::ceil(2 * patch.halfEdge[a] / kGrid_m));
        for (int k = 0; k < count[1]; ++k)
            for (int l = 0; l < count[2]; ++l) {
                const int at[3] = {0, k, l};
                Eigen::Vector3d p = map.origin();
                for (int d = 0; d < 3; ++d) p[d] += double(patch.mean[d]);
                for (int a = 1; a < 3; ++a) {
                    const double share = count[a] > 1 ? at[a] / double(count[a] - 1) : 0.5;
                    for (int d = 0; d < 3; ++d)
                        p[d] += (2 * share - 1) * double(patch.halfEdge[a]) *
                                double(patch.axes[a][d]);
                }
                points.push_back(p);
            }
    }
    return points;
}

Eigen::Matrix3d randomRotation(std::mt19937_64& engine) {
    const Eigen::Quaterniond q(normal(engine), normal(engine), normal(engine),
                               normal(engine));
    return q.normalized().toRotationMatrix();
}

Eigen::Vector3d pointInRoom(std::mt19937_64& engine) {
    return {uniform(engine, -4.2, 4.2), uniform(engine, -3.2, 3.2),
            uniform(engine, -0.2, 2.7)};
}

Capsule capsuleInRoom(std::mt19937_64& engine) {
    Capsule body;
    body.from = body.to = pointInRoom(engine);
    if (uniform(engine, 0, 1) < 0.7)
        for (int d = 0; d < 3; ++d) body.to[d] += uniform(engine, -1, 1);
    body.radius_m = uniform(engine, 0.02, 0.5);
    return body;
}

OrientedBox boxInRoom(std::mt19937_64& engine) {
    OrientedBox body;
    body.centre = pointInRoom(engine);
    body.axes = randomRotation(engine);
    for (int d = 0; d < 3; ++d) body.halfEdges[d] = uniform(engine, 0.02, 0.5);
    return body;
}

/// Distance from a point to a body by its definition [m]; 0 inside.
double distanceToBody(const Capsule& body, const Eigen::Vector3d& p) {
    const Eigen::Vector3d along = body.to - body.from;
    const double share =
        along.squaredNorm() > 0
            ? std::clamp((p - body.from).dot(along) / along.squaredNorm(), 0.0, 1.0)
            : 0.0;
    return std::max(0.0, (p - body.from - share * along).norm() - body.radius_m);
}
double distanceToBody(const OrientedBox& body, const Eigen::Vector3d& p) {
    const Eigen::Vector3d local = body.axes.transpose() * (p - body.centre);
    return (local.cwiseAbs() - body.halfEdges).cwiseMax(0.0).norm();
}

/// None that a sampled patch is in is missed; few that are clear are blocked.
template <typename Body>
void expectNoneMissed(Body (*draw)(std::mt19937_64&), int bodies) {
    static const std::vector<Eigen::Vector3d> points = patchPoints(roomWithAChest());
    std::mt19937_64 engine(5);
    int met = 0, clear = 0, blocked = 0;
    for (int k = 0; k < bodies; ++k) {
        const Body body = draw(engine);
        double nearest = std::numeric_limits<double>::infinity();
        const Eigen::Vector3d centre = centreOf(body);
        const Eigen::Array3d reach = reachOf(body).array() + 2 * kGrid_m;
        for (const Eigen::Vector3d& p : points)
            if (((p - centre).array().abs() < reach).all())
                nearest = std::min(nearest, distanceToBody(body, p));
        const Collision answer = roomWithAChest().collision(body);
        if (nearest == 0.0) {
            ++met;
            // Rounding of the float patches.
            EXPECT_GE(answer.probability, 0.5 - 1e-3);
        } else if (nearest > kGrid_m) {
            ++clear;
            if (answer.probability >= 0.5) ++blocked;
        }
        EXPECT_EQ(answer.probability > 0, answer.component != Collision::kNone);
        EXPECT_LE(answer.probability, 1.0);
    }
    EXPECT_GT(met, bodies / 10);
    EXPECT_GT(clear, bodies / 10);
    EXPECT_EQ(blocked, 0) << "touching is exact";
}

TEST(Collision, OfCapsulesMissesNoPatch) {
    expectNoneMissed<Capsule>(capsuleInRoom, 200);
}

TEST(Collision, OfBoxesMissesNoPatch) {
    expectNoneMissed<OrientedBox>(boxInRoom, 200);
}

/// Against points of the segment: the gap is the least of their distances.
TEST(Collision, GapOfACapsuleIsExact) {
    std::mt19937_64 engine(3);
    for (int k = 0; k < 300; ++k) {
        Mixture<3> mixture;
        Gaussian<3> g;
        g.support = 10;
        for (int d = 0; d < 3; ++d) g.mean[d] = uniform(engine, -1, 1);
        g.covariance = 0.1 * randomCovariance<3>(engine, 50);
        mixture.pushBack(g);
        const SurfacePatch<3> patch = *patchOf<3>(mixture, 0);
        const Capsule body = capsuleInRoom(engine);
        double least = std::numeric_limits<double>::infinity();
        for (int i = 0; i <= 2000; ++i) {
            Capsule ball = body;
            ball.from = ball.to = body.from + (body.to - body.from) * i / 2000.0;
            least = std::min(least, gapTo(ball, patch));
        }
        EXPECT_LE(gapTo(body, patch), least + 1e-9);
        EXPECT_NEAR(gapTo(body, patch), least, 1e-3);
    }
}

TEST(Collision, IsAsProbableAsThePatchIsNear) {
    const double wall_m = 4.0;
    const auto at = [&](double gap_m) {
        const Eigen::Vector3d centre(wall_m - 0.3 - gap_m, -1.0, 1.2);
        return roomWithAChest().collision(Capsule{centre, centre, 0.3}).probability;
    };
    EXPECT_EQ(at(0.5), 0.0);
    double last = 0.0;
    for (double gap = 0.1; gap > -0.1; gap -= 0.002) {
        EXPECT_GE(at(gap), last);
        last = at(gap);
    }
    EXPECT_GT(last, 0.99);
    EXPECT_NEAR(at(0.0), 0.5, 0.2);
}

TEST(Collision, TakesUnknownSpaceAsAsked) {
    CollisionParams params;
    const Capsule outside{{9, 0, 1}, {9, 0, 1}, 0.2}, inside{{-1, 0, 1}, {0, 1, 1}, 0.2};
    const Capsule halfOut{{-3, 0, 1}, {-3, 9, 1}, 0.05};
    EXPECT_EQ(roomWithAChest().collision(outside, params).probability, 0.0);
    params.unknown = UnknownSpace::occupied;
    EXPECT_TRUE(roomWithAChest().collision(outside, params).unknown);
    EXPECT_EQ(roomWithAChest().collision(outside, params).probability, 1.0);
    EXPECT_FALSE(roomWithAChest().collision(inside, params).unknown);
    EXPECT_EQ(roomWithAChest().collision(inside, params).probability, 0.0);
    EXPECT_TRUE(roomWithAChest().collision(halfOut, params).unknown);
    EXPECT_TRUE(Map().collision(inside, params).unknown);
    EXPECT_EQ(Map().collision(inside).probability, 0.0);
    OrientedBox box;
    box.centre = {-1, 0, 1};
    box.halfEdges = {0.4, 0.2, 0.3};
    EXPECT_FALSE(roomWithAChest().collision(box, params).unknown);
    box.halfEdges.x() = 20;
    EXPECT_TRUE(roomWithAChest().collision(box, params).unknown);
}

TEST(Collision, RefusesBodiesThatAreNone) {
    const double nan = std::nan("");
    EXPECT_THROW(roomWithAChest().collision(Capsule{{0, 0, nan}, {0, 0, 0}, 1}),
                 std::invalid_argument);
    EXPECT_THROW(roomWithAChest().collision(Capsule{{0, 0, 0}, {0, 0, 0}, -1}),
                 std::invalid_argument);
    OrientedBox box;
    box.halfEdges = {1, -1, 1};
    EXPECT_THROW(roomWithAChest().collision(box), std::invalid_argument);
    box.halfEdges = {1, 1, 1};
    box.axes *= 2;
    EXPECT_THROW(roomWithAChest().collision(box), std::invalid_argument);
    EXPECT_THROW(roomWithAChest().collision(Capsule{}, {}, 99), std::out_of_range);
    CollisionParams params;
    params.unknownSpacing_m = 0;
    EXPECT_THROW(roomWithAChest().collision(Capsule{}, params), std::invalid_argument);
    params.unknownSpacing_m = 1e-3;
    params.unknown = UnknownSpace::occupied;
    EXPECT_THROW(roomWithAChest().collision(Capsule{{-4, 0, 0}, {4, 3, 2}, 1}, params),
                 std::invalid_argument);
}

}  // namespace
}  // namespace hgmm
