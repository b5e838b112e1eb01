#include "hgmm/evaluation/nearest_baseline.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "wall_scene.h"

using namespace hgmm::evaluation;
using namespace wall_scene;

TEST(NearestBaseline, MeasuresAsBruteForceDoes) {
    const Points points = randomPoints(400, 11), queries = randomPoints(300, 12);
    NearestBaseline map;
    EXPECT_TRUE(ask(map, 0.5).unknown);
    EXPECT_EQ(ask(map, 0.5).probability, 0.0);
    for (std::size_t inserted : {100U, 400U}) {
        hgmm::Scan scan;
        for (std::size_t i = inserted == 100 ? 0 : 100; i < inserted; ++i)
            addPoint(scan, points[i]);
        map.insert(scan);
        std::vector<Answer> answers(queries.size());
        map.query(queries.data(), queries.size(), answers.data());
        for (std::size_t q = 0; q < queries.size(); ++q) {
            double nearest_m = 1e9;
            for (std::size_t i = 0; i < inserted; ++i)
                nearest_m = std::min(nearest_m, (points[i] - queries[q]).norm());
            EXPECT_FALSE(answers[q].unknown);
            EXPECT_NEAR(answers[q].probability, 1 / (1 + nearest_m / 0.1), 1e-5);
        }
    }
    EXPECT_EQ(map.meaning(), Meaning::nearness);
    EXPECT_GT(map.liveBytes(), 400 * 3 * sizeof(float));
}

TEST(NearestBaseline, IsAsExactFarFromTheOrigin) {
    hgmm::Scan scan = rays(1);
    scan.T_map_sensor.t += Eigen::Vector3d(4.0e6, -3.0e6, 0.0);
    NearestBaseline map;
    map.insert(scan);
    const Eigen::Vector3d hit = Eigen::Vector3d(kWall_m + 4.0e6, 0.53 - 3.0e6, 0.73);
    EXPECT_NEAR(ask(map, hit).probability, 1.0, 1e-4);
    EXPECT_NEAR(ask(map, hit + Eigen::Vector3d(0, 0.1, 0)).probability, 0.5, 1e-4);
}

TEST(NearestBaseline, PointsThatCoincideAreKeptOnce) {
    NearestBaseline once, often;
    once.insert(rays(1));
    const std::size_t bytes = once.liveBytes();
    for (int i = 0; i < 50; ++i) often.insert(rays(1));
    EXPECT_EQ(often.liveBytes(), bytes);
    ask(once, 0.5);
    EXPECT_GT(once.liveBytes(), bytes) << "the index counts when it is there";
}
