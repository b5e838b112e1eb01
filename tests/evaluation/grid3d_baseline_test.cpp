#include "hgmm/evaluation/grid3d_baseline.h"

#include <gtest/gtest.h>

#include <cmath>
#include <stdexcept>

#include "wall_scene.h"

using namespace hgmm::evaluation;
using namespace wall_scene;

namespace {

// MRPT's defaults of 2.5.8: log-odds in sixteenths; a certainty of 0.65 is ln(.65/.35) =
// .62, so 10 of them, for a miss; a hit counts three times.
double probability(double sixteenths) {
    return 1.0 / (1.0 + std::exp(-sixteenths / 16));
}

}  // namespace

TEST(Grid3dBaseline, OneRay) {
    Grid3dBaseline map(0.1);
    EXPECT_TRUE(ask(map, kWall_m).unknown) << "nothing was seen yet";
    EXPECT_EQ(map.liveBytes(), 0U);
    map.insert(rays(1));
    EXPECT_NEAR(ask(map, kWall_m).probability, probability(30), 1e-6);
    for (double x = 1.03; x < 2.98; x += 0.1) {
        EXPECT_FALSE(ask(map, x).unknown) << x;
        EXPECT_NEAR(ask(map, x).probability, probability(-10), 1e-6) << x;
    }
    for (const Answer& answer : {ask(map, kWall_m + 0.1), ask(map, 0.93),
                                 ask(map, 2.0, 0.63), ask(map, 0.88), ask(map, 1e6)}) {
        EXPECT_TRUE(answer.unknown);
        EXPECT_EQ(answer.probability, 0.5);
    }
    map.insert(rays(2));
    EXPECT_NEAR(ask(map, kWall_m).probability, probability(90), 1e-6);
    EXPECT_NEAR(ask(map, 2.0).probability, probability(-30), 1e-6);
    // At exactly even odds a voxel is as it was at first.
    map.insert(rays(9, {kWall_m + 1, 0.53, 0.73}));
    EXPECT_TRUE(ask(map, kWall_m).unknown);
}

TEST(Grid3dBaseline, GrowsAndKeepsWhatItKnew) {
    Grid3dBaseline map(0.1);
    map.insert(rays(1));
    const std::size_t before = map.liveBytes();
    const double hit = ask(map, kWall_m).probability;
    map.insert(rays(1, {1.03, -7.47, 0.73}));
    map.insert(rays(1, {1.03, 0.53, 5.73}));
    EXPECT_EQ(ask(map, kWall_m).probability, hit);
    EXPECT_NEAR(ask(map, 1.03, -7.47).probability, probability(30), 1e-6);
    EXPECT_NEAR(ask(map, 1.03, 0.53, 5.73).probability, probability(30), 1e-6);
    EXPECT_NEAR(ask(map, 1.03, -3.0).probability, probability(-10), 1e-6);
    // One byte per voxel of the box of all scans, with one voxel around it at least.
    EXPECT_GT(map.liveBytes(), before);
    EXPECT_GE(map.liveBytes(), 23U * 83U * 53U);
    EXPECT_LE(map.liveBytes(), 25U * 85U * 55U);
    EXPECT_GT(map.serializedBytes().value(), map.liveBytes());
}

TEST(Grid3dBaseline, RefusesToFillTheMemory) {
    Grid3dBaseline map(0.01);
    EXPECT_THROW(map.insert(rays(1, {300.0, 300.0, 300.0})), std::runtime_error);
    EXPECT_EQ(map.liveBytes(), 0U);
    map.insert(rays(1, {3.035, 0.535, 0.735}));
    EXPECT_NEAR(ask(map, 3.035, 0.535, 0.735).probability, probability(30), 1e-6);
}
