#include "hgmm/evaluation/scene.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <stdexcept>

using namespace hgmm::evaluation;
using Eigen::Vector3d;

namespace {

const auto kAll = [](Part) { return true; };

Scene boxAndPillar() {
    Scene scene;
    scene.add(Box{{2, -1, 0}, {3, 1, 2}}, Part::solid);
    scene.add(Pillar{{0, 5}, 0.5, 0.0, 1.0}, Part::pole);
    return scene;
}

}  // namespace

TEST(Scene, RangesByHand) {
    const Scene scene = boxAndPillar();
    const auto front = scene.cast({0, 0, 1}, {1, 0, 0});
    ASSERT_TRUE(front);
    EXPECT_DOUBLE_EQ(front->range_m, 2.0);
    EXPECT_EQ(front->normal, Vector3d(-1, 0, 0));
    EXPECT_EQ(front->part, Part::solid);
    // 3-4-5: from 3.2 m aside into the side y = 1, at x = 2.4.
    const auto side = scene.cast({0, 4.2, 1}, Vector3d(2.4, -3.2, 0).normalized());
    ASSERT_TRUE(side);
    EXPECT_NEAR(side->range_m, 4.0, 1e-12);
    EXPECT_EQ(side->normal, Vector3d(0, 1, 0));
    const auto top = scene.cast({2.5, 0, 5}, {0, 0, -1});
    ASSERT_TRUE(top);
    EXPECT_DOUBLE_EQ(top->range_m, 3.0);
    EXPECT_FALSE(scene.cast({0, 0, 1}, {-1, 0, 0}));
    EXPECT_FALSE(scene.cast({0, 0, 2.5}, {1, 0, 0}));
}

TEST(Scene, PillarsHaveSidesAndEnds) {
    const Scene scene = boxAndPillar();
    const auto side = scene.cast({0.3, 0, 0.5}, {0, 1, 0});
    ASSERT_TRUE(side);
    EXPECT_NEAR(side->range_m, 5.0 - 0.4, 1e-12);  // 3-4-5 of radius .5
    EXPECT_NEAR((side->normal - Vector3d(0.6, -0.8, 0)).norm(), 0.0, 1e-12);
    EXPECT_EQ(side->part, Part::pole);
    const auto lid = scene.cast({0.1, 5, 3}, {0, 0, -1});
    ASSERT_TRUE(lid);
    EXPECT_DOUBLE_EQ(lid->range_m, 2.0);
    EXPECT_EQ(lid->normal, Vector3d(0, 0, 1));
    // Above the sides, down onto the lid.
    const auto slanted = scene.cast({0, 3, 3}, Vector3d(0, 1, -1).normalized());
    ASSERT_TRUE(slanted);
    EXPECT_NEAR(slanted->range_m, 2.0 * std::sqrt(2.0), 1e-12);
    EXPECT_FALSE(scene.cast({0, 0, 1.5}, {0, 1, 0}));
    EXPECT_FALSE(scene.cast({0.6, 0, 0.5}, {0, 1, 0}));
}

TEST(Scene, TheNearestSolidHidesOthersInAnyOrder) {
    for (const bool nearFirst : {true, false}) {
        Scene scene;
        const auto add = [&](double x, Part part) {
            scene.add(Box{{x, -1, -1}, {x + 1, 1, 1}}, part);
        };
        add(nearFirst ? 2 : 4, nearFirst ? Part::moving : Part::wall);
        add(nearFirst ? 4 : 2, nearFirst ? Part::wall : Part::moving);
        scene.add(Pillar{{8, 0}, 0.5, -1, 1}, Part::pole);
        const auto hit = scene.cast({0, 0, 0}, {1, 0, 0});
        ASSERT_TRUE(hit);
        EXPECT_DOUBLE_EQ(hit->range_m, 2.0);
        EXPECT_EQ(hit->part, Part::moving);
    }
}

// A hit lies on a surface, nothing is inside on the way there, and rays without a hit meet
// nothing: an oracle that marches by distances.
TEST(Scene, CastsAgreeWithMarchingByDistance) {
    const Scene scene = boxAndPillar();
    std::mt19937_64 engine(3);
    std::normal_distribution<double> normal;
    int hits = 0;
    for (int i = 0; i < 2000; ++i) {
        const Vector3d origin(0.2 * normal(engine), 2.0 + 0.2 * normal(engine), 1.2);
        const Vector3d direction =
            Vector3d(normal(engine), normal(engine), 0.3 * normal(engine)).normalized();
        double marched_m = 0.0;
        double gap_m = 1.0;
        while (marched_m < 30.0 && gap_m > 1e-9) {
            gap_m = scene.distance(origin + marched_m * direction, kAll);
            marched_m += gap_m;
        }
        const auto hit = scene.cast(origin, direction);
        if (marched_m >= 30.0) {
            EXPECT_FALSE(hit) << i;
            continue;
        }
        ASSERT_TRUE(hit) << i;
        EXPECT_NEAR(hit->range_m, marched_m, 1e-4) << i;
        EXPECT_LT(hit->normal.dot(direction), 0.0);
        ++hits;
    }
    EXPECT_GT(hits, 200);
}

TEST(Scene, DistancesByHandAndByPart) {
    const Scene scene = boxAndPillar();
    EXPECT_DOUBLE_EQ(scene.distance({1, 0, 1}, kAll), 1.0);
    EXPECT_DOUBLE_EQ(scene.distance({2.5, 0, 1}, kAll), 0.0);
    EXPECT_DOUBLE_EQ(scene.distance({6, 5, 1}, kAll), 5.0);  // edge (3, 1): 3-4-5
    const auto isPole = [](Part part) { return part == Part::pole; };
    EXPECT_DOUBLE_EQ(scene.distance({3.5, 5, 5}, isPole), 5.0);  // rim (.5, 5, 1): 3-4-5
    EXPECT_TRUE(std::isinf(scene.distance({0, 0, 0}, [](Part) { return false; })));
}

TEST(Scene, SolidsWithoutVolumeAreRefused) {
    Scene scene;
    EXPECT_THROW(scene.add(Box{{0, 0, 0}, {1, 0, 1}}, Part::wall), std::invalid_argument);
    EXPECT_THROW(scene.add(Pillar{{0, 0}, 0.0, 0, 1}, Part::pole), std::invalid_argument);
    EXPECT_THROW(scene.add(Pillar{{0, 0}, 0.1, 1, 1}, Part::pole), std::invalid_argument);
}
