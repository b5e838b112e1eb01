#include <gtest/gtest.h>

#include <cmath>

#include "hgmm/evaluation/changing_room.h"
#include "hgmm/evaluation/map_under_test.h"
#include "hgmm/evaluation/solid_room.h"

using namespace hgmm::evaluation;
using Eigen::Vector3d;

namespace {

bool isSolid(Part part) {
    return part == Part::solid;
}
bool isMoving(Part part) {
    return part == Part::moving;
}

double castFrom(const Scene& scene, const Vector3d& from, const Vector3d& along) {
    const auto hit = scene.cast(from, along.normalized());
    return hit ? hit->range_m : -1.0;
}

}  // namespace

TEST(SolidRoom, HiddenPointsAreWellWithinSolidsOrBehindWalls) {
    const Scene scene = solid_room::room();
    const auto hidden = solid_room::hiddenPoints(1000, 0.0, 5);
    ASSERT_EQ(hidden.size(), 6U);
    for (std::size_t kind = 0; kind < 6; ++kind) {
        ASSERT_EQ(hidden[kind].points_map.size(), 1000U);
        for (const Vector3d& p : hidden[kind].points_map) {
            const Eigen::Vector2d outside(std::max(-p.x(), p.x() - 12.0),
                                          std::max(-p.y(), p.y() - 8.0));
            if (kind < 4) {
                for (int i = 0; i < 8; ++i) {
                    const double angle = M_PI / 4 * i;
                    const Vector3d aside(0.0399 * std::cos(angle), 0.0399 * std::sin(angle),
                                         0);
                    ASSERT_EQ(scene.distance(p + aside, isSolid), 0.0) << hidden[kind].kind;
                }
            } else if (kind == 4) {
                ASSERT_GE(outside.maxCoeff(), 0.15);
                ASSERT_LE(outside.maxCoeff(), 1.6);
                ASSERT_LE(outside.minCoeff(), 0.0);
            } else {
                ASSERT_GE(outside.minCoeff(), 0.15);
                ASSERT_LE(outside.maxCoeff(), 1.6);
            }
        }
    }
    for (const auto& points : solid_room::hiddenPoints(100, 1.0, 5))
        for (const Vector3d& p : points.points_map) ASSERT_EQ(p.z(), 1.0);
    EXPECT_EQ(solid_room::hiddenPoints(10, 0, 5)[0].points_map[9],
              solid_room::hiddenPoints(10, 0, 5)[0].points_map[9]);
    EXPECT_NE(solid_room::hiddenPoints(10, 0, 5)[0].points_map[9],
              solid_room::hiddenPoints(10, 0, 6)[0].points_map[9]);
}

TEST(SolidRoom, RoutesKeepClearOfSolids) {
    const Scene scene = solid_room::room();
    const auto any = [](Part) { return true; };
    for (const auto route : {solid_room::Route::round, solid_room::Route::through}) {
        const auto poses = solid_room::poses(route, 75);
        ASSERT_EQ(poses.size(), 75U);
        for (const hgmm::Pose& pose : poses) {
            ASSERT_GT(scene.distance(pose.t, any), 0.3);
            ASSERT_NEAR(pose.R.determinant(), 1.0, 1e-9);
            ASSERT_EQ(pose.t.z(), 1.0);
        }
    }
    // Round: each looks to the middle, where nothing stands.
    for (const hgmm::Pose& pose : solid_room::poses(solid_room::Route::round, 9)) {
        const Vector3d ahead = pose.R.col(0), middle(6, 4, 1);
        EXPECT_NEAR(ahead.dot((middle - pose.t).normalized()), 1.0, 1e-12);
    }
}

TEST(ChangingRoom, IsAsDescribed) {
    const Scene closed = changing_room::room(changing_room::Background::closed);
    const Scene open = changing_room::room(changing_room::Background::open);
    const Vector3d middle(6, 5, 1);
    EXPECT_NEAR(castFrom(closed, middle, {-1, 0, 0}), 6.0, 1e-12);
    EXPECT_NEAR(castFrom(closed, middle, {0, 1, 0}), 5.0, 1e-12);
    EXPECT_NEAR(castFrom(closed, middle, {0, 0, 1}), 2.0, 1e-12);
    // Through the doorway, a wall of .2 m and a corridor of 3 m; beside and above it not.
    EXPECT_NEAR(castFrom(closed, middle, {1, 0, 0}), 9.2, 1e-12);
    EXPECT_NEAR(castFrom(closed, {6, 5.49, 1}, {1, 0, 0}), 9.2, 1e-12);
    EXPECT_NEAR(castFrom(closed, {6, 5.51, 1}, {1, 0, 0}), 6.0, 1e-12);
    EXPECT_NEAR(castFrom(closed, {6, 5, 1.99}, {1, 0, 0}), 9.2, 1e-12);
    EXPECT_NEAR(castFrom(closed, {6, 5, 2.01}, {1, 0, 0}), 6.0, 1e-12);
    EXPECT_EQ(castFrom(open, middle, {1, 0, 0}), -1.0);
    EXPECT_EQ(castFrom(open, middle, {1, 0.2, 0.1}), -1.0);
    const auto pole = closed.cast(middle, Vector3d(4.0, 1.6, 0).normalized());
    ASSERT_TRUE(pole);
    EXPECT_EQ(pole->part, Part::pole);
    const auto table = closed.cast({9.8, 3.3, 2}, {0, 0, -1});
    ASSERT_TRUE(table);
    EXPECT_EQ(table->part, Part::tableTop);
    EXPECT_NEAR(castFrom(closed, {9.8, 3.3, 0.1}, {0, 0, 1}), 0.62, 1e-12);  // 3 cm thick
}

TEST(ChangingRoom, ThingsStandWhereTheyShould) {
    const Scene empty = changing_room::room(changing_room::Background::closed);
    const Vector3d middle(6, 5, 1), ahead(1, 0, 0);
    Scene box = empty, person = empty, flush = empty, recessed = empty, partition = empty;
    changing_room::addBox(box);
    changing_room::addPerson(person, 5.0);
    changing_room::addDoor(flush, 0.0);
    changing_room::addDoor(recessed, 0.11);
    changing_room::addPartition(partition);
    EXPECT_NEAR(castFrom(box, middle, ahead), 2.5, 1e-12);
    EXPECT_NEAR(castFrom(box, {6, 5, 1.21}, ahead), 9.2, 1e-12);
    EXPECT_NEAR(castFrom(person, middle, ahead), 2.25, 1e-12);
    EXPECT_NEAR(castFrom(person, {6, 5, 1.71}, ahead), 9.2, 1e-12);
    EXPECT_NEAR(castFrom(flush, middle, ahead), 6.0, 1e-12);
    EXPECT_NEAR(castFrom(recessed, middle, ahead), 6.11, 1e-12);
    EXPECT_NEAR(castFrom(partition, middle, ahead), 3.0, 1e-12);
    for (const Scene* scene : {&box, &person, &flush, &recessed, &partition})
        EXPECT_EQ(scene->cast(middle, ahead)->part, Part::moving);
}

TEST(ChangingRoom, PersonWalksOneMetreASecondAndKeepsClear) {
    EXPECT_NEAR(changing_room::personAt(0), 3.5, 1e-12);
    EXPECT_NEAR(changing_room::personAt(30), 6.5, 1e-12);
    EXPECT_NEAR(changing_room::personAt(60), 3.5, 1e-12);
    const Scene empty = changing_room::room(changing_room::Background::closed);
    for (int i = 0; i < 300; ++i) {
        const double y = changing_room::personAt(i);
        EXPECT_NEAR(std::abs(changing_room::personAt(i + 1) - y), 0.1, 1e-9);
        EXPECT_GT(empty.distance({8.5, y, 1.0}, [](Part part) { return !isMoving(part); }),
                  0.25 + 0.12);
    }
}

TEST(MapUnderTest, CountsUnknownHalf) {
    const auto answer = [](float occupied, float free) {
        hgmm::Occupancy o;
        o.occupied = occupied;
        o.free = free;
        o.unknown = 1.F - occupied - free;
        return o;
    };
    EXPECT_TRUE(saysOccupied(answer(0.25F, 0.125F)));
    EXPECT_FALSE(saysFree(answer(0.25F, 0.125F)));
    EXPECT_TRUE(saysFree(answer(0.125F, 0.25F)));
    EXPECT_FALSE(saysFree(answer(0.F, 0.F))) << "unknown is neither";
    EXPECT_FALSE(saysOccupied(answer(0.F, 0.F)));
    EXPECT_FALSE(saysFree(answer(0.25F, 0.25F)));
    const std::vector<hgmm::Occupancy> answers{answer(1, 0), answer(0, 1), answer(0, 1),
                                               answer(0, 0)};
    EXPECT_DOUBLE_EQ(shareOf(answers, saysFree), 0.5);
    EXPECT_DOUBLE_EQ(shareOf(answers, saysOccupied), 0.25);
    EXPECT_EQ(shareOf({}, saysFree), 0.0);
}

TEST(MapUnderTest, OursAndOthersAnswerForTheSameScan) {
    hgmm::Scan scan;
    for (int i = -40; i <= 40; ++i)
        for (int j = -20; j <= 20; ++j)
            scan.pushBack(2.02F, 0.02F * static_cast<float>(i),
                          0.02F * static_cast<float>(j));
    const auto ours = oursUnderTest({});
    const auto other = baselineUnderTest("octomap:0.05", SensorKind::lidar);
    EXPECT_EQ(ours->name(), "hgmm");
    EXPECT_EQ(other->name(), "octomap:0.05");
    for (const auto* map : {&ours, &other}) {
        (*map)->insert(scan);
        const auto answers = (*map)->occupancy({{2.02, 0, 0}, {1.0, 0, 0}, {0, 0, 30}});
        EXPECT_TRUE(saysOccupied(answers[0])) << (*map)->name();
        EXPECT_TRUE(saysFree(answers[1])) << (*map)->name();
        EXPECT_GT(answers[2].unknown, 0.99F) << (*map)->name();
        EXPECT_EQ((*map)->insert_ms().size(), 1U);
    }
    EXPECT_GT(ours->components().surface, 0U);
    EXPECT_EQ(other->components().surface, 0U);
    EXPECT_THROW(baselineUnderTest("octomop", SensorKind::lidar), std::invalid_argument);
}
