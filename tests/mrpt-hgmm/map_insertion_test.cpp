#include <gtest/gtest.h>
#include <mrpt/maps/CHGMMOccupancyMap.h>
#include <mrpt/obs/CObservationOdometry.h>

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
