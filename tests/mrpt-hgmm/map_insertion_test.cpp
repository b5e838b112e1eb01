#include <gtest/gtest.h>
#include <mrpt/maps/CHGMMOccupancyMap.h>
#include <mrpt/obs/CObservationOdometry.h>

#include <Eigen/Eigenvalues>
#include <thread>
#include <vector>

#include "hgmm/mrpt_bridge/observation_to_scan.h"
#include "laser_room.h"
#include "observation/shared_samples.h"
#include "observations.h"

using mrpt::maps::CHGMMOccupancyMap;
using mrpt::poses::CPose3D;

namespace {

/// Mean, in the map frame, of the components of two maps: equal sets in equal order.
void expectSameComponents(const CHGMMOccupancyMap& a, const CHGMMOccupancyMap& b,
                          const std::string& name) {
    const auto &m = a.model().mixture(), &n = b.model().mixture();
    ASSERT_EQ(m.size(), n.size()) << name;
    for (std::size_t i = 0; i < m.size(); ++i) {
        const auto g = m[i], h = n[i];
        EXPECT_NEAR(g.support, h.support, 1e-3) << name << " " << i;
        for (int d = 0; d < 3; ++d)
            EXPECT_NEAR(g.mean[d] + a.model().origin()[d],
                        h.mean[d] + b.model().origin()[d], 1e-4)
                << name << " " << i;
        EXPECT_LT((g.covariance - h.covariance).cwiseAbs().maxCoeff(), 1e-4)
            << name << " " << i;
    }
}

// The trap of two stock maps: one of the poses is lost for some observation types.
TEST(MapInsertion, RobotAndSensorPoseCountAlikeForEveryType) {
    const CPose3D A(2, -1, 0.5, 0.5, 0.1, 0.05), B(0.2, 0.1, 1.1, -0.3, 0.2, 0.1);
    for (const auto& [name, o] : observations::all()) {
        CHGMMOccupancyMap split, joined;
        o->setSensorPose(B);
        ASSERT_TRUE(split.insertObservation(*o, A)) << name;
        o->setSensorPose(CPose3D());
        ASSERT_TRUE(joined.insertObservation(*o, A + B)) << name;
        EXPECT_GE(split.model().mixture().size(), 2U) << name;
        expectSameComponents(split, joined, name);
    }
}

// All points of a planar laser lie in one plane: corners must not make the walls thick.
TEST(MapInsertion, WallsOfAPlanarLaserAreThin) {
    const CHGMMOccupancyMap map = laser_room::map();
    const auto& mixture = map.model().mixture();
    std::size_t pieces = 0;
    for (std::size_t i = 0; i < mixture.size(); ++i) {
        const Eigen::Matrix3d covariance = mixture[i].covariance;
        const Eigen::Vector3d sigma =
            Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(covariance)
                .eigenvalues()
                .cwiseSqrt();
        pieces += sigma[2] > 0.1;
        EXPECT_LT(sigma[1], 0.03) << i << ", " << sigma[2] << " m long";
    }
    EXPECT_GE(pieces, 4U);
}

TEST(MapInsertion, NoPoseMeansTheOrigin) {
    CHGMMOccupancyMap without, origin;
    without.insertObservation(*observations::cloud());
    origin.insertObservation(*observations::cloud(), CPose3D());
    EXPECT_EQ(without.model(), origin.model());
}

TEST(MapInsertion, WhatIsNotUnderstoodOrEmptyIsNotAChange) {
    CHGMMOccupancyMap map;
    EXPECT_FALSE(map.insertObservation(mrpt::obs::CObservationOdometry()));
    EXPECT_FALSE(map.insertObservation(mrpt::obs::CObservation2DRangeScan()));
    EXPECT_TRUE(map.isEmpty());
    EXPECT_TRUE(map.insertObservation(*observations::laser()));
    EXPECT_FALSE(map.isEmpty());
}

TEST(MapInsertion, InsertionCanBeSwitchedOff) {
    CHGMMOccupancyMap map;
    map.genericMapParams.enableObservationInsertion = false;
    EXPECT_FALSE(map.insertObservation(*observations::laser()));
    EXPECT_TRUE(map.isEmpty());
}

TEST(MapInsertion, OptionsReachTheModel) {
    CHGMMOccupancyMap fine, coarse;
    coarse.insertionOptions.params.filter.minRange_m = 3.5;
    fine.insertObservation(*observations::laser());
    coarse.insertObservation(*observations::laser());
    EXPECT_EQ(coarse.model().params().filter.minRange_m, 3.5);
    EXPECT_LT(coarse.model().mixture().totalSupport(),
              fine.model().mixture().totalSupport());
    coarse.insertionOptions.params.filter.minRange_m = -1;
    EXPECT_THROW(coarse.insertObservation(*observations::laser()), std::invalid_argument);
}

// An unsupported observation must not even apply options, bad ones here.
TEST(MapInsertion, WhatIsNotUnderstoodTouchesNothing) {
    CHGMMOccupancyMap map;
    map.insertionOptions.params.filter.minRange_m = -1;
    EXPECT_FALSE(map.insertObservation(mrpt::obs::CObservationOdometry()));
}

TEST(MapInsertion, SharedSamplesOutliveOtherObservations) {
    const auto scan = observations::laser();
    const hgmm::MapParams params;
    const auto samples = hgmm::mrpt_bridge::sharedSamplesOf(*scan, params, {});
    ASSERT_TRUE(samples);
    for (int i = 0; i < 9; ++i)
        EXPECT_FALSE(hgmm::mrpt_bridge::sharedSamplesOf(mrpt::obs::CObservationOdometry(),
                                                        params, {}));
    EXPECT_EQ(hgmm::mrpt_bridge::sharedSamplesOf(*scan, params, {}), samples);
    hgmm::mrpt_bridge::forgetSharedSamples();
    EXPECT_NE(hgmm::mrpt_bridge::sharedSamplesOf(*scan, params, {}), samples);
}

// What is made of an observation is shared by all maps of the process: by particles.
TEST(MapInsertion, SharedSamplesAreThoseOfTheScan) {
    for (const auto& [name, o] : observations::all()) {
        const CPose3D here(0.3, -0.2, 0.1, 0.4, 0, 0), there(5, 1, 0.1, -1, 0.1, 0);
        CHGMMOccupancyMap first, second, direct;
        first.insertObservation(*o, here);
        second.insertObservation(*o, there);
        direct.insertScan(*hgmm::mrpt_bridge::observationToScan(*o, there));
        EXPECT_EQ(second.model(), direct.model()) << name;
        EXPECT_NE(first.model(), second.model()) << name;
        second.auxParticleFilterCleanUp();
        CHGMMOccupancyMap third;
        third.insertObservation(*o, there);
        EXPECT_EQ(third.model(), second.model()) << name;
    }
}

TEST(MapInsertion, ObservationThatChangedIsNotTakenForWhatItWas) {
    const auto scan = observations::laser(1001);
    CHGMMOccupancyMap before, after, fresh;
    before.insertObservation(*scan);
    scan->setScanRange(501, 1.F);  // one ray, in the middle
    after.insertObservation(*scan);
    EXPECT_NE(after.model(), before.model());
    after.auxParticleFilterCleanUp();
    fresh.insertObservation(*scan);
    EXPECT_EQ(after.model(), fresh.model());
    // The same observation with other options.
    CHGMMOccupancyMap coarse;
    coarse.insertionOptions.params.filter.resolution_m = 0.2;
    coarse.insertObservation(*scan);
    EXPECT_LT(coarse.model().mixture().size(), fresh.model().mixture().size());
}

TEST(MapInsertion, ThreadsShareSamples) {
    const auto scan = observations::laser();
    CHGMMOccupancyMap expected;
    expected.insertObservation(*scan);
    std::vector<CHGMMOccupancyMap> maps(8);
    std::vector<std::thread> threads;
    for (auto& map : maps)
        threads.emplace_back([&map, &scan] {
            for (int i = 0; i < 20; ++i) {
                map.clear();
                if (i % 5 == 0) map.auxParticleFilterCleanUp();
                map.insertObservation(*scan);
            }
        });
    for (auto& thread : threads) thread.join();
    for (const auto& map : maps) EXPECT_EQ(map.model(), expected.model());
}

TEST(MapInsertion, ClearAndCloneAndDescribe) {
    CHGMMOccupancyMap map;
    map.insertObservation(*observations::cloud());
    map.likelihoodOptions.maxPoints = 7;
    const auto copy =
        std::dynamic_pointer_cast<CHGMMOccupancyMap>(map.duplicateGetSmartPtr());
    ASSERT_TRUE(copy);
    const std::string size = std::to_string(map.model().mixture().size());
    EXPECT_NE(map.asString().find(size), std::string::npos) << map.asString();
    map.clear();
    EXPECT_TRUE(map.isEmpty());
    EXPECT_FALSE(copy->isEmpty()) << "a clone has a model of its own";
    EXPECT_EQ(copy->likelihoodOptions.maxPoints, 7);
}

}  // namespace
