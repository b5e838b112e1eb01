#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>
#include <stdexcept>

#include "hgmm/evaluation/likelihood.h"
#include "hgmm/evaluation/memory.h"
#include "hgmm/evaluation/reconstruction.h"
#include "hgmm/evaluation/timing.h"

using namespace hgmm::evaluation;

TEST(Reconstruction, DistancesBothWaysByHand) {
    // From the model: 0.03 and 1; from the measurements: 0.03, 0.04 and 2.
    const Points model{{0, 0, 0}, {11, 0, 0}};
    const Points measured{{0.03, 0, 0}, {0, 0.04, 0}, {10, 0, 0}};
    const Points far{{0, 0, 0}, {12, 0, 0}};
    const Reconstruction near = compareSurfaces(model, measured);
    EXPECT_NEAR(near.accuracy_m, (0.03 + 1.0) / 2, 1e-12);
    EXPECT_NEAR(near.completeness_m, (0.03 + 0.04 + 1.0) / 3, 1e-12);
    EXPECT_NEAR(near.chamfer_m, 0.5 * (1.03 / 2 + 1.07 / 3), 1e-12);
    EXPECT_DOUBLE_EQ(near.precision, 0.5);
    EXPECT_DOUBLE_EQ(near.recall, 2.0 / 3.0);
    EXPECT_NEAR(near.f1, 2 * 0.5 * (2.0 / 3) / (0.5 + 2.0 / 3), 1e-12);
    EXPECT_NEAR(compareSurfaces(far, measured).completeness_m, (0.03 + 0.04 + 2.0) / 3,
                1e-12);
}

TEST(Reconstruction, F1UsesItsThreshold) {
    const Points model{{0, 0, 0}}, measured{{0.2, 0, 0}};
    EXPECT_EQ(compareSurfaces(model, measured).f1, 0.0);
    EXPECT_EQ(compareSurfaces(model, measured, 0.21).f1, 1.0);
    EXPECT_EQ(compareSurfaces(model, model).f1, 1.0);
}

TEST(Reconstruction, NearestDistancesAgreeWithBruteForce) {
    std::mt19937_64 engine(11);
    std::uniform_real_distribution<double> uniform(-3.0, 3.0);
    const auto draw = [&](std::size_t n) {
        Points points;
        for (std::size_t i = 0; i < n; ++i)
            points.emplace_back(uniform(engine) + 4.0e5, uniform(engine),
                                0.1 * uniform(engine));
        return points;
    };
    const Points queries = draw(200), targets = draw(300);
    const std::vector<double> distances = nearestDistances(queries, targets);
    for (std::size_t i = 0; i < queries.size(); ++i) {
        double nearest = std::numeric_limits<double>::infinity();
        for (const auto& t : targets) nearest = std::min(nearest, (t - queries[i]).norm());
        EXPECT_NEAR(distances[i], nearest, 1e-9);
    }
}

TEST(Reconstruction, EmptySetsAreRefused) {
    EXPECT_THROW(compareSurfaces({}, {{0, 0, 0}}), std::invalid_argument);
    EXPECT_THROW(compareSurfaces({{0, 0, 0}}, {}), std::invalid_argument);
}

TEST(Reconstruction, SurfaceSamplesLieAroundTheComponentInTheMapFrame) {
    hgmm::Gaussian<3> g;
    g.support = 10.0;
    g.mean << 1.0, 2.0, 3.0;
    g.covariance.diagonal() << 0.04, 0.01, 1e-4;
    hgmm::Mixture<3> mixture;
    mixture.pushBack(g);
    const Points points = sampleSurface(mixture, {100.0, 200.0, -50.0}, 20000, 5);
    ASSERT_EQ(points.size(), 20000U);
    Eigen::Vector3d mean = Eigen::Vector3d::Zero();
    for (const auto& p : points) mean += p / 20000.0;
    // Five standard errors.
    EXPECT_NEAR(mean.x(), 101.0, 5 * 0.2 / std::sqrt(20000.0));
    EXPECT_NEAR(mean.y(), 202.0, 5 * 0.1 / std::sqrt(20000.0));
    EXPECT_NEAR(mean.z(), -47.0, 5 * 0.01 / std::sqrt(20000.0));
}

TEST(HeldOutLikelihood, ByHand) {
    // A box of 1 x 2 x 0 m, grown to 3 x 4 x 2.
    const Points hits{{0, 0, 0}, {1, 2, 0}};
    const double p[] = {0.5, 0.0};
    const auto logDensity = [&](const Eigen::Vector3d& x) {
        return std::log(p[x.x() > 0.5]);
    };
    const double floor = 0.01 / 24.0;
    EXPECT_NEAR(heldOutLogLikelihood(logDensity, hits),
                0.5 * (std::log(0.99 * 0.5 + floor) + std::log(floor)), 1e-12);
}

TEST(HeldOutLikelihood, FarPointsStayFiniteAndBadDensitiesAreRefused) {
    const Points hits{{0, 0, 0}, {1e6, 0, 0}};
    const double infinity = std::numeric_limits<double>::infinity();
    const auto constant = [](double v) {
        return [v](const Eigen::Vector3d&) { return v; };
    };
    EXPECT_TRUE(std::isfinite(heldOutLogLikelihood(constant(-infinity), hits)));
    EXPECT_TRUE(std::isfinite(heldOutLogLikelihood(constant(-1e300), hits)));
    EXPECT_THROW(heldOutLogLikelihood(constant(infinity), hits), std::runtime_error);
    EXPECT_THROW(heldOutLogLikelihood(constant(std::nan("")), hits), std::runtime_error);
    EXPECT_THROW(heldOutLogLikelihood(constant(0.0), {}), std::invalid_argument);
}

TEST(Timing, OfTheNumbersOneToHundredInReverse) {
    std::vector<double> ms;
    for (int i = 100; i >= 1; --i) ms.push_back(i);
    const Timing t = summariseTimes(ms);
    EXPECT_DOUBLE_EQ(t.median, 50.5);
    EXPECT_DOUBLE_EQ(t.p99, 99.0);
    EXPECT_DOUBLE_EQ(t.worst, 100.0);
    EXPECT_DOUBLE_EQ(t.firstTenth, 95.5);
    EXPECT_DOUBLE_EQ(t.lastTenth, 5.5);
}

TEST(Timing, OfFewScans) {
    EXPECT_EQ(summariseTimes({}).worst, 0.0);
    const Timing one = summariseTimes({3.0});
    EXPECT_EQ(one.median, 3.0);
    EXPECT_EQ(one.p99, 3.0);
    EXPECT_EQ(one.firstTenth, 3.0);
    EXPECT_EQ(one.lastTenth, 3.0);
    EXPECT_EQ(median({4.0, 1.0, 3.0}), 3.0);
    EXPECT_EQ(median({4.0, 1.0, 3.0, 2.0}), 2.5);
}

// Level 0 is what is saved: the sizes of components are those of the core's format.
TEST(Memory, BytesOfLevel0AreThoseOfTheSavedMapButForItsHeader) {
    const std::size_t header = hgmm::Map().save().size();
    hgmm::Scan scan;
    std::mt19937_64 engine(5);
    std::uniform_real_distribution<float> uniform(-4.0F, 4.0F);
    for (int i = 0; i < 20000; ++i) {
        const float u = uniform(engine), v = uniform(engine);
        scan.pushBack(u, v, 3.0F + 0.3F * std::sin(2 * u));
        scan.pushBack(u, 4.0F + 0.3F * std::sin(2 * v), v);
    }
    hgmm::Map map;
    map.insert(scan);
    ASSERT_GT(map.mixture().size(), 100U);
    ASSERT_GT(map.freeMixture().size(), 100U);
    const auto components = double(map.save().size() - header);
    EXPECT_NEAR(double(levelBytes(map, 0)), components, 0.05 * components);
    EXPECT_GT(map.coverageBytes(), 500U);
    // One kind alone must not hide behind the other.
    const auto free = double(kFreeBytes * map.freeMixture().size());
    EXPECT_GT(free, 0.1 * components);
    EXPECT_LT(free, 0.9 * components);
}

TEST(Memory, ALevelIsItsSurfaceAndItsFreeSpace) {
    hgmm::Scan scan;
    for (int i = -20; i <= 20; ++i)
        for (int j = -20; j <= 20; ++j)
            scan.pushBack(0.1F * float(i), 0.1F * float(j), 2.0F);
    hgmm::Map map;
    map.insert(scan);
    for (std::size_t level = 0; level < map.levelCount(); ++level)
        EXPECT_EQ(levelBytes(map, level), 20 * map.mixture(level).size() +
                                              23 * map.freeMixture(level).size() +
                                              map.coverageBytes(level));
    EXPECT_EQ(levelBytes(hgmm::Map(), 0), 0U);
    EXPECT_THROW(levelBytes(map, map.levelCount()), std::out_of_range);
}

TEST(Memory, ComesFromTheMapItself) {
    const hgmm::Map map;
    EXPECT_EQ(memoryOf(map).serialized_bytes, map.save().size());
    EXPECT_EQ(memoryOf(map).live_bytes, map.liveBytes());
}
