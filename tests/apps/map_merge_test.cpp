#include <mrpt/maps/CHGMMOccupancyMap.h>

#include <cstdio>

#include "replay_map_fixture.h"

/// Two maps of one room from the two halves of a recording.
class MapMergeTool : public ReplayFolder {
 protected:
    void SetUp() override {
        ReplayFolder::SetUp();
        const std::string room = recordRoom(12, 3000);
        ASSERT_EQ(replay(room + " --to 6 --save-map " + path("a.hgmm")).exitCode, 0);
        ASSERT_EQ(replay(room + " --from 5 --save-map " + path("b.hgmm")).exitCode, 0);
    }
    Outcome merge(const std::string& options) const {
        return mapTool("merge '" + path("a.hgmm") + "' '" + path("b.hgmm") + "' -o '" +
                       path("c.hgmm") + "' " + options);
    }
    mrpt::maps::CHGMMOccupancyMap load(const std::string& name) const {
        mrpt::maps::CHGMMOccupancyMap map;
        map.loadFromFile(path(name));
        return map;
    }
};

TEST_F(MapMergeTool, JoinsMapsOfOneFrame) {
    const Outcome outcome = merge("");
    ASSERT_EQ(outcome.exitCode, 0) << outcome.err;
    const auto a = load("a.hgmm"), b = load("b.hgmm"), c = load("c.hgmm");
    const double supports =
        a.model().mixture().totalSupport() + b.model().mixture().totalSupport();
    EXPECT_NEAR(c.model().mixture().totalSupport(), supports, 0.01 * supports);
    EXPECT_LT(c.model().mixture().size(),
              a.model().mixture().size() + b.model().mixture().size());
    expectHas(outcome.out, "0.0000,0.0000,0.0000,0.000,0.000,0.000");
}

TEST_F(MapMergeTool, RefinesAPoseThatIsALittleOff) {
    const Outcome outcome = merge("--pose=0.3,-0.2,0.1,4,1,-1 --refine");
    ASSERT_EQ(outcome.exitCode, 0) << outcome.err;
    const auto at = outcome.out.find("pose of the other map");
    ASSERT_NE(at, std::string::npos) << outcome.out;
    double x = 9, y = 9, z = 9, yaw = 9, pitch = 9, roll = 9;
    ASSERT_EQ(std::sscanf(outcome.out.c_str() + at,
                          "pose of the other map %lf,%lf,%lf,%lf,%lf,%lf", &x, &y, &z, &yaw,
                          &pitch, &roll),
              6);
    EXPECT_LT(std::hypot(x, y, z), 0.05) << outcome.out;
    EXPECT_LT(std::hypot(yaw, pitch, roll), 0.5) << outcome.out;
}

TEST_F(MapMergeTool, WhatCannotBeMergedIsSaid) {
    const Outcome far = merge("--pose=500,0,0,0,0,0 --refine");
    EXPECT_EQ(far.exitCode, 1);
    expectHas(far.err, "could not be aligned");
    EXPECT_TRUE(content("c.hgmm").empty());
    EXPECT_EQ(merge("--pose=1,2,3").exitCode, 2);
    EXPECT_EQ(merge("--pose=nan,0,0,0,0,0").exitCode, 1);
    EXPECT_EQ(mapTool("merge '" + path("a.hgmm") + "' '" + path("none.hgmm") + "' -o '" +
                      path("c.hgmm") + "'")
                  .exitCode,
              1);
}
