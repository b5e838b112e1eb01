#include <gtest/gtest.h>
#include <omp.h>

#include <Eigen/Geometry>
#include <cmath>
#include <limits>

#include "coloured_scenes.h"

namespace hgmm {
namespace {

using testing::mapOf;
using testing::modelling;
using testing::paintedWall;
using testing::patches;
using testing::plain;

TEST(ModalityMap, AGradientIsOneLineEverywhere) {
    const auto gradient = [](double y, double z) { return 0.5 + 0.3 * y - 0.2 * z; };
    const Map map = mapOf(paintedWall({{"r", gradient}}), {"r"});
    ASSERT_NE(map.modality("r"), nullptr);
    for (double y = -0.5; y < 0.55; y += 0.1)
        for (double z = -0.3; z < 0.35; z += 0.1) {
            const ModalityEstimate e = map.modality("r", {2, y, z});
            ASSERT_TRUE(e.known);
            EXPECT_NEAR(e.mean, gradient(y, z), 0.01);
            EXPECT_LT(e.variance, 0.03 * 0.03);
        }
    EXPECT_EQ(map.modality("r")->size(),
              mapOf(paintedWall({{"r", plain(0.5)}}), {"r"}).modality("r")->size())
        << "nothing had to be split";
}

/// Thesis 5.3.3: colour edges inside one spatial component.
TEST(ModalityMap, AnEdgeInsideAPlaneIsSharp) {
    // Off the edges of all cells, and slanting.
    const auto edge = [](double y, double z) { return y + 0.3 * z < 0.07 ? 0.2 : 0.8; };
    const Map map = mapOf(paintedWall({{"r", edge}}), {"r"});
    double squares = 0, n = 0;
    for (double z = -0.3; z < 0.35; z += 0.02)
        for (const double beside : {-0.05, -0.035, 0.035, 0.05}) {
            const double y = 0.07 - 0.3 * z + beside;
            const double error = map.modality("r", {2, y, z}).mean - edge(y, z);
            squares += error * error, n += 1;
        }
    EXPECT_LT(std::sqrt(squares / n), 0.12) << "3 to 5 cm beside the edge, which is 0.6";
    EXPECT_LT(map.modality("r")->size(), 120U);
    // The variance knows where the edge is.
    EXPECT_GT(map.modality("r", {2, 0.07, 0}).variance,
              20 * map.modality("r", {2, -0.4, 0.2}).variance);
}

/// The default fidelity is that of thesis table 5.1 and better, on what was not inserted.
TEST(ModalityMap, ExplainsWhatIsAskedFor) {
    const auto checks = [](double y, double z) {
        return 0.5 + 0.3 * std::sin(12 * y) * std::cos(9 * z);
    };
    for (const double unexplained : {0.2, 0.07, 0.03}) {
        MapParams params = modelling({"r"});
        params.modality.modalityUnexplained = unexplained;
        Map map(params);
        map.insert(paintedWall({{"r", checks}}));
        double error = 0, spread = 0;
        for (double y = -0.555; y < 0.56; y += 0.01)
            for (double z = -0.355; z < 0.36; z += 0.01) {
                const double value = checks(y, z);
                error += std::pow(map.modality("r", {2, y, z}).mean - value, 2);
                spread += std::pow(value - 0.5, 2);
            }
        EXPECT_LT(error / spread, 1.2 * unexplained + 0.01);
    }
}

TEST(ModalityMap, ChannelsMeasuredTogetherShareTheirPlaces) {
    const Scan scan = paintedWall({{"r", patches({0.1, 0.9, 0.4})},
                                   {"g", plain(0.5)},
                                   {"b", [](double y, double) { return 0.5 + 0.5 * y; }}});
    const Map map = mapOf(scan, {"r", "g", "b"});
    const auto &r = map.modality("r")->mixture(), &b = map.modality("b")->mixture();
    ASSERT_EQ(r.size(), b.size());
    for (int d = 0; d < 3; ++d) EXPECT_EQ(r.mean[d], b.mean[d]);
    EXPECT_NEAR(map.modality("b", {2, 0.3, 0.1}).mean, 0.65, 0.02);
    EXPECT_NEAR(map.modality("g", {2, 0.3, 0.1}).mean, 0.5, 0.01);
    EXPECT_NEAR(map.modality("r", {2, 0, 0.1}).mean, 0.9, 0.02);
}

TEST(ModalityMap, SurfacesAreTheSameWithAndWithoutModalities) {
    const Scan scan = paintedWall({{"r", patches({0.1, 0.9, 0.4})}});
    const Map with = mapOf(scan, {"r"}), without = mapOf(scan, {});
    EXPECT_TRUE(with.mixture() == without.mixture());
    EXPECT_TRUE(with.freeMixture() == without.freeMixture());
    EXPECT_TRUE(without.modalities().empty());
    EXPECT_EQ(without.modality("r"), nullptr);
    EXPECT_THROW(without.modality("r", {2, 0, 0}), std::invalid_argument);
    EXPECT_GT(with.liveBytes(), without.liveBytes());
}

TEST(ModalityMap, AnswersDoNotDependOnThreads) {
    const Scan scan = paintedWall({{"r", patches({0.1, 0.9, 0.4})}, {"g", plain(0.3)}});
    std::vector<Eigen::Vector3d> points;
    for (double y = -0.6; y < 0.6; y += 0.001) points.emplace_back(2, y, 0.3 * y);
    std::vector<std::vector<ModalityEstimate>> answers;
    std::vector<std::vector<std::uint8_t>> buffers;
    const int before = omp_get_max_threads();
    for (const int threads : {1, 2, 5}) {
        omp_set_num_threads(threads);
        const Map map = mapOf(scan, {"r", "g"});
        buffers.push_back(map.save(Encoding::exact));
        answers.emplace_back(points.size());
        map.modality("r", points.data(), points.size(), answers.back().data());
        for (std::size_t i = 0; i < points.size(); i += 100) {
            const ModalityEstimate one = map.modality("r", points[i]);
            EXPECT_EQ(one.mean, answers.back()[i].mean);
            EXPECT_EQ(one.variance, answers.back()[i].variance);
        }
    }
    omp_set_num_threads(before);
    EXPECT_TRUE(buffers[0] == buffers[1]);
    EXPECT_TRUE(buffers[0] == buffers[2]);
    for (std::size_t i = 0; i < points.size(); ++i)
        ASSERT_EQ(answers[0][i].mean, answers[1][i].mean);
}

TEST(ModalityMap, FarFromTheOriginNothingChanges) {
    Scan scan = paintedWall({{"r", patches({0.1, 0.9, 0.4})}});
    const Map near = mapOf(scan, {"r"});
    const Eigen::Vector3d offset(100000, -70000, 3000);
    scan.T_map_sensor.t += offset;
    const Map far = mapOf(scan, {"r"});
    for (double y = -0.6; y < 0.6; y += 0.01) {
        const Eigen::Vector3d p(2, y, 0.1);
        EXPECT_NEAR(near.modality("r", p).mean, far.modality("r", p + offset).mean, 1e-6);
    }
}

TEST(ModalityMap, ManyViewsAgreeAndStayCompact) {
    const std::vector<std::pair<std::string, testing::Painting>> painting = {
        {"r", patches({0.1, 0.9, 0.4, 0.7, 0.2})}};
    Map map(modelling({"r"}));
    std::size_t first = 0;
    for (std::uint64_t k = 1; k <= 10; ++k) {
        map.insert(paintedWall(painting, k));
        if (k == 1) first = map.modality("r")->size();
    }
    EXPECT_LT(map.modality("r")->size(), 2 * first);
    EXPECT_NEAR(map.modality("r")->mixture().totalSupport(), 10 * 240 * 160, 1);
    EXPECT_NEAR(map.modality("r", {2, -0.24, 0}).mean, 0.9, 0.03);
    EXPECT_NO_THROW(map.modality("r")->mixture().check());
}

/// A coarse look first, then a close one that shows an edge.
TEST(ModalityMap, DetailSeenLaterIsLearnt) {
    const auto edge = [](double y, double) { return y < 0.07 ? 0.2 : 0.8; };
    Map map(modelling({"r"}));
    map.insert(paintedWall({{"r", plain(0.5)}}, 1, 24, 16));
    map.insert(paintedWall({{"r", edge}}, 2));
    EXPECT_LT(map.modality("r", {2, 0.0, 0}).mean, 0.3);
    EXPECT_GT(map.modality("r", {2, 0.14, 0}).mean, 0.7);
}

TEST(ModalityMap, HalvesMergeToTheWhole) {
    const std::vector<std::pair<std::string, testing::Painting>> painting = {
        {"r", patches({0.1, 0.9, 0.4})}, {"g", plain(0.3)}};
    Map one = mapOf(paintedWall(painting, 1), {"r", "g"});
    Scan turned = paintedWall(painting, 2);
    const Pose T{Eigen::AngleAxisd(0.5, Eigen::Vector3d::UnitZ()).toRotationMatrix(),
                 {3, 4, 5}};
    turned.T_map_sensor = T;
    const Map two = mapOf(turned, {"r", "g", "b"});
    one.merge(two, T.inverse());
    EXPECT_NEAR(one.modality("r")->mixture().totalSupport(), 2 * 240 * 160, 10);
    for (double y = -0.5; y < 0.55; y += 0.05) {
        const double near = std::abs(std::abs(y) - 0.2);
        if (near < 0.04) continue;
        EXPECT_NEAR(one.modality("r", {2, y, 0.1}).mean, patches({0.1, 0.9, 0.4})(y, 0),
                    0.05);
    }
    EXPECT_NO_THROW(one.modality("g")->mixture().check());
    Map none = mapOf(paintedWall(painting, 1), {});
    none.merge(two, T.inverse());
    EXPECT_EQ(none.modality("r"), nullptr) << "this map's parameters stay";
    Map blank(modelling({"r"}));
    blank.merge(two);
    EXPECT_TRUE(blank.modality("r", T.R * Eigen::Vector3d(2, 0, 0) + T.t).known);
}

TEST(ModalityMap, ClearForgets) {
    Map map = mapOf(paintedWall({{"r", plain(0.3)}}), {"r"});
    map.clear();
    EXPECT_EQ(map.modality("r"), nullptr);
    EXPECT_EQ(map.modalities().size(), 1U);
    EXPECT_FALSE(map.modality("r", {2, 0, 0}).known);
    MapParams other = modelling({"g"});
    Map dropping = mapOf(paintedWall({{"r", plain(0.3)}}), {"r"});
    dropping.setParams(other);
    EXPECT_EQ(dropping.modality("r"), nullptr);
}

}  // namespace
}  // namespace hgmm
