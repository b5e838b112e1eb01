#include <gtest/gtest.h>
#include <mrpt/maps/CHGMMOccupancyMap.h>
#include <mrpt/maps/CSimplePointsMap.h>
#include <mrpt/obs/CObservationOdometry.h>
#include <mrpt/obs/CObservationPointCloud.h>

#include <limits>
#include <thread>

#include "copy_through_archive.h"
#include "observations.h"

using archives::copyThroughArchive;
using mrpt::maps::CHGMMOccupancyMap;
using mrpt::poses::CPose3D;

namespace {

CHGMMOccupancyMap roomMap() {
    CHGMMOccupancyMap map;
    map.insertObservation(*observations::laser(), CPose3D(0, 0, 0.2, 0, 0, 0));
    map.insertObservation(*observations::laser(), CPose3D(0, 0, 0.2, M_PI, 0, 0));
    map.likelihoodOptions.kernelWidth_m = 0.05;
    map.likelihoodOptions.outlierRatio = 0.05;
    map.likelihoodOptions.maxPoints = 1000;
    map.likelihoodOptions.independentPoints = hgmm::mrpt_bridge::kMaxPoints;
    return map;
}

const CPose3D kTrue(0, 0, 0.2, 0, 0, 0);

TEST(Likelihood, IsHighestAtThePoseOfTheScan) {
    const CHGMMOccupancyMap map = roomMap();
    const auto scan = observations::laser();
    const double best = map.computeObservationLikelihood(*scan, kTrue);
    EXPECT_LE(best, 0);
    EXPECT_GT(best, -0.5 * double(scan->getScanSize()));
    double last = best;
    for (const double shift_m : {0.3, 0.6, 1.2}) {
        const double value =
            map.computeObservationLikelihood(*scan, CPose3D(shift_m, 0, 0.2, 0, 0, 0));
        EXPECT_LT(value, last) << shift_m;
        last = value;
    }
    EXPECT_LT(map.computeObservationLikelihood(*scan, CPose3D(0, 0, 0.2, 0.5, 0, 0)),
              best - 5);
}

TEST(Likelihood, SensorPoseIsComposedWithTheRobots) {
    const CHGMMOccupancyMap map = roomMap();
    const auto scan = observations::laser();
    const double expected = map.computeObservationLikelihood(*scan, kTrue);
    const CPose3D sensor(0.5, -0.2, 0.1, 0.3, 0, 0);
    scan->setSensorPose(sensor);
    EXPECT_NEAR(map.computeObservationLikelihood(*scan, kTrue - sensor), expected, 1e-3);
}

TEST(Likelihood, IsFiniteEverywhere) {
    const CHGMMOccupancyMap map = roomMap();
    const auto scan = observations::laser();
    const double floor = double(std::min<std::size_t>(map.likelihoodOptions.maxPoints,
                                                      scan->getScanSize())) *
                         std::log(map.likelihoodOptions.outlierRatio);
    const double nan = std::numeric_limits<double>::quiet_NaN();
    for (const CPose3D& pose :
         {CPose3D(1e3, 0, 0, 0, 0, 0), CPose3D(1e12, -1e12, 1e12, 1, 1, 1),
          CPose3D(nan, 0, 0, 0, 0, 0)})
        EXPECT_NEAR(map.computeObservationLikelihood(*scan, pose), floor, 1e-6) << pose;
}

TEST(Likelihood, IsZeroWhereThereIsNothingToCompare) {
    const CHGMMOccupancyMap map = roomMap(), empty;
    EXPECT_EQ(empty.computeObservationLikelihood(*observations::laser(), kTrue), 0);
    EXPECT_EQ(map.computeObservationLikelihood(mrpt::obs::CObservationOdometry(), kTrue),
              0);
    EXPECT_EQ(map.computeObservationLikelihood(mrpt::obs::CObservation2DRangeScan(), kTrue),
              0);
    EXPECT_TRUE(map.canComputeObservationLikelihood(*observations::laser()));
    EXPECT_FALSE(map.canComputeObservationLikelihood(mrpt::obs::CObservationOdometry()));
}

TEST(Likelihood, UsesAtMostMaxPointsInRange) {
    CHGMMOccupancyMap map = roomMap();
    const auto scan = observations::laser();
    const CPose3D far(1e3, 0, 0, 0, 0, 0);
    const double perPoint = std::log(map.likelihoodOptions.outlierRatio);
    for (const int points : {1, 10, 181, 5000}) {
        map.likelihoodOptions.maxPoints = points;
        EXPECT_NEAR(map.computeObservationLikelihood(*scan, far),
                    std::min(points, 181) * perPoint, 1e-6);
    }
    // A product of so small factors does not fit a double.
    map.likelihoodOptions.outlierRatio = 1e-9;
    EXPECT_NEAR(map.computeObservationLikelihood(*scan, far), 181 * std::log(1e-9), 1e-6);
    map.likelihoodOptions.outlierRatio = 0.05;
    map.likelihoodOptions.minRange_m = 4.5;  // the room's corners only
    const double corners = map.computeObservationLikelihood(*scan, far) / perPoint;
    EXPECT_GT(corners, 5);
    EXPECT_LT(corners, 100);
    map.likelihoodOptions.outlierRatio = 1;
    EXPECT_THROW(map.computeObservationLikelihood(*scan, far), std::exception);
}

TEST(Likelihood, ComparesFewerPointsOfPlanarLasersByDefault) {
    CHGMMOccupancyMap map = roomMap();
    map.likelihoodOptions.maxPoints = 0;
    const CPose3D far(1e3, 0, 0, 0, 0, 0);
    const double perPoint = std::log(map.likelihoodOptions.outlierRatio);
    EXPECT_NEAR(map.computeObservationLikelihood(*observations::laser(), far),
                60 * perPoint, 1e-6);
    for (const int points : {500, 3000}) {
        const auto cloud = mrpt::maps::CSimplePointsMap::Create();
        for (int i = 0; i < points; ++i)
            cloud->insertPoint(3.F, 0.001F * static_cast<float>(i), 1.F);
        mrpt::obs::CObservationPointCloud observation;
        observation.pointcloud = cloud;
        EXPECT_NEAR(map.computeObservationLikelihood(observation, far),
                    std::min(points, 1000) * perPoint, 1e-6);
    }
}

TEST(Likelihood, PointsBeyondTheIndependentOnesDoNotMakeItSurer) {
    CHGMMOccupancyMap map = roomMap();
    const auto scan = observations::laser();
    const CPose3D shifted(0.1, 0, 0.2, 0, 0, 0);
    const double all = map.computeObservationLikelihood(*scan, shifted);
    map.likelihoodOptions.independentPoints = 181;
    EXPECT_DOUBLE_EQ(map.computeObservationLikelihood(*scan, shifted), all);
    map.likelihoodOptions.independentPoints = 20;
    EXPECT_NEAR(map.computeObservationLikelihood(*scan, shifted), all * 20 / 181, 1e-9);
    // Points that are not compared do not count.
    map.likelihoodOptions.maxPoints = 20;
    const double few = map.computeObservationLikelihood(*scan, shifted);
    map.likelihoodOptions.independentPoints = 181;
    EXPECT_DOUBLE_EQ(map.computeObservationLikelihood(*scan, shifted), few);
}

TEST(Likelihood, FollowsTheMapAndTheOptions) {
    CHGMMOccupancyMap map = roomMap();
    const auto scan = observations::laser();
    const CPose3D shifted(0.2, 0, 0.2, 0, 0, 0);
    const double before = map.computeObservationLikelihood(*scan, shifted);
    map.likelihoodOptions.kernelWidth_m = 0.5;
    EXPECT_GT(map.computeObservationLikelihood(*scan, shifted), before + 1);
    map.likelihoodOptions.kernelWidth_m = 0.05;
    EXPECT_DOUBLE_EQ(map.computeObservationLikelihood(*scan, shifted), before);
    map.insertObservation(*scan, shifted);
    EXPECT_GT(map.computeObservationLikelihood(*scan, shifted), before);
    map.clear();
    EXPECT_EQ(map.computeObservationLikelihood(*scan, shifted), 0);
}

TEST(Likelihood, ModelChangedByHandIsSeen) {
    CHGMMOccupancyMap map = roomMap();
    const auto scan = observations::laser();
    const double before = map.computeObservationLikelihood(*scan, kTrue);
    CHGMMOccupancyMap other;
    other.likelihoodOptions = map.likelihoodOptions;
    other.insertObservation(*observations::cloud());
    map.model() = other.model();
    EXPECT_NE(map.computeObservationLikelihood(*scan, kTrue), before);
    EXPECT_EQ(map.computeObservationLikelihood(*scan, kTrue),
              other.computeObservationLikelihood(*scan, kTrue));
}

// The same address may hold another observation next time.
TEST(Likelihood, CachedObservationIsNotMistakenForAnother) {
    const CHGMMOccupancyMap map = roomMap();
    for (const auto& [name, o] : observations::all()) {
        const CHGMMOccupancyMap fresh = map;
        const double before = fresh.computeObservationLikelihood(*o, kTrue);
        EXPECT_DOUBLE_EQ(fresh.computeObservationLikelihood(*o, kTrue), before) << name;
        o->setSensorPose(CPose3D(0.7, 0.3, 0.05, 0.3, 0, 0));
        const CHGMMOccupancyMap uncached = map;
        EXPECT_EQ(fresh.computeObservationLikelihood(*o, kTrue),
                  uncached.computeObservationLikelihood(*o, kTrue))
            << name;
    }
    const auto scan = observations::laser();
    const double before = map.computeObservationLikelihood(*scan, kTrue);
    for (std::size_t i = 0; i < scan->getScanSize(); ++i) scan->setScanRange(i, 1.F);
    EXPECT_NE(map.computeObservationLikelihood(*scan, kTrue), before);
}

TEST(Likelihood, CleanUpForgetsObservationsOnly) {
    CHGMMOccupancyMap map = roomMap();
    const auto scan = observations::laser();
    const double before = map.computeObservationLikelihood(*scan, kTrue);
    map.auxParticleFilterCleanUp();
    EXPECT_EQ(map.computeObservationLikelihood(*scan, kTrue), before);
}

// Surfaces are brought up to date in place, or copied first where a copy of the map has
// them, too.
TEST(Likelihood, CopiesFollowTheirOwnMap) {
    CHGMMOccupancyMap map = roomMap();
    const auto scan = observations::laser();
    const CPose3D moved(0.1, 0.05, 0.2, 0.1, 0, 0);
    const double before = map.computeObservationLikelihood(*scan, moved);
    const CHGMMOccupancyMap copy = map;
    map.insertObservation(*scan, moved);
    CHGMMOccupancyMap fresh;
    fresh.model() = map.model();
    fresh.likelihoodOptions = map.likelihoodOptions;
    EXPECT_GT(map.computeObservationLikelihood(*scan, moved), before);
    EXPECT_EQ(map.computeObservationLikelihood(*scan, moved),
              fresh.computeObservationLikelihood(*scan, moved));
    EXPECT_EQ(copy.computeObservationLikelihood(*scan, moved), before);
    // Copied while it is out of date.
    map.insertObservation(*scan, CPose3D(0.2, 0, 0.2, 0, 0, 0));
    const CHGMMOccupancyMap late = map;
    fresh.model() = map.model();
    EXPECT_EQ(late.computeObservationLikelihood(*scan, moved),
              fresh.computeObservationLikelihood(*scan, moved));
}

// MRPT copies the maps of particles through archives: the copy takes over the surfaces that
// the original has ready, and neither sees what the other inserts afterwards.
TEST(Likelihood, CopiesThroughArchivesFollowTheirOwnMap) {
    const auto scan = observations::laser();
    const CPose3D moved(0.1, 0.05, 0.2, 0.1, 0, 0);
    CHGMMOccupancyMap map = roomMap();
    map.likelihoodOptions.kernelWidth_m = 0.1;  // one for all that is asked here
    const auto fresh = [&](const CHGMMOccupancyMap& like) {
        CHGMMOccupancyMap anew;
        anew.model() = like.model();
        anew.likelihoodOptions = like.likelihoodOptions;
        return anew.computeObservationLikelihood(*scan, moved);
    };
    const double before = map.computeObservationLikelihood(*scan, moved);
    const auto copy = copyThroughArchive(map), changed = copyThroughArchive(map);
    EXPECT_EQ(copy->computeObservationLikelihood(*scan, moved), before);
    map.insertObservation(*scan, moved);
    EXPECT_GT(map.computeObservationLikelihood(*scan, moved), before);
    EXPECT_EQ(copy->computeObservationLikelihood(*scan, moved), before);
    changed->insertObservation(*scan, CPose3D(0.2, 0, 0.2, 0, 0, 0));
    EXPECT_EQ(changed->computeObservationLikelihood(*scan, moved), fresh(*changed));
    EXPECT_EQ(copy->computeObservationLikelihood(*scan, moved), before);
    EXPECT_EQ(map.computeObservationLikelihood(*scan, moved), fresh(map));
    // Copied while it is out of date.
    map.insertObservation(*scan, CPose3D(0.3, 0, 0.2, 0, 0, 0));
    const auto late = copyThroughArchive(map);
    EXPECT_EQ(late->computeObservationLikelihood(*scan, moved), fresh(map));
    map.insertObservation(*scan, CPose3D(0.3, 0.1, 0.2, 0, 0, 0));
    EXPECT_EQ(map.computeObservationLikelihood(*scan, moved), fresh(map));
}

// pf-localization's repetitions share one map between threads.
TEST(Likelihood, ThreadsGetTheSameAsOneThread) {
    CHGMMOccupancyMap map = roomMap();
    map.computeObservationLikelihood(*observations::laser(), kTrue);
    // Now the first thread that comes brings the surfaces up to date.
    map.insertObservation(*observations::laser(), CPose3D(0.3, 0, 0.2, 0.2, 0, 0));
    constexpr int threads = 4, poses = 200;
    const auto evaluate = [](const CHGMMOccupancyMap& m, int seed) {
        const auto scan = observations::laser(100 + seed);
        std::vector<double> values;
        for (int i = 0; i < poses; ++i)
            values.push_back(m.computeObservationLikelihood(
                *scan, CPose3D(0.01 * i, -0.005 * i, 0.2, 0.01 * i, 0, 0)));
        return values;
    };
    std::vector<std::vector<double>> parallel(threads);
    std::vector<std::thread> pool;
    for (int t = 0; t < threads; ++t)
        pool.emplace_back([&, t] { parallel[t] = evaluate(map, t); });
    for (auto& thread : pool) thread.join();
    CHGMMOccupancyMap fresh;
    fresh.model() = map.model();
    fresh.likelihoodOptions = map.likelihoodOptions;
    for (int t = 0; t < threads; ++t) EXPECT_EQ(parallel[t], evaluate(fresh, t));
}

}  // namespace
