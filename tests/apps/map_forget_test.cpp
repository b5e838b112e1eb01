#include <mrpt/maps/CHGMMOccupancyMap.h>

#include "replay_map_fixture.h"

/// A saved map of a room.
class MapForgetTool : public ReplayFolder {
 protected:
    void SetUp() override {
        ReplayFolder::SetUp();
        ASSERT_EQ(replay(recordRoom(4, 1500) + " --save-map " + path("room.hgmm")).exitCode,
                  0);
    }
    Outcome forget(const std::string& box) const {
        return mapTool("forget '" + path("room.hgmm") + "' '" + path("less.hgmm") +
                       "' --box=" + box);
    }
    mrpt::maps::CHGMMOccupancyMap load(const std::string& name) const {
        mrpt::maps::CHGMMOccupancyMap map;
        map.loadFromFile(path(name));
        return map;
    }
};

TEST_F(MapForgetTool, WritesTheMapWithoutWhatIsInTheBox) {
    const Outcome outcome = forget("-100,-100,-100,100,0,100");
    ASSERT_EQ(outcome.exitCode, 0) << outcome.err;
    const auto all = load("room.hgmm"), less = load("less.hgmm");
    mrpt::maps::CHGMMOccupancyMap expected = all;
    const std::size_t forgotten = expected.forget({{-100, -100, -100}, {100, 0, 100}});
    ASSERT_GT(forgotten, 0U);
    EXPECT_LT(forgotten, all.model().mixture().size());
    EXPECT_EQ(less.model().save(), expected.model().save());
    expectHas(outcome.out, std::to_string(forgotten) + " forgotten");
}

TEST_F(MapForgetTool, ABadBoxIsSaidAndNothingIsWritten) {
    for (const char* box : {"1,0,0,-1,1,1", "nan,0,0,1,1,1"}) {
        const Outcome outcome = forget(box);
        EXPECT_EQ(outcome.exitCode, 1) << box;
        expectHas(outcome.err, "--box");
    }
    EXPECT_EQ(forget("1,2,3").exitCode, 2);
    EXPECT_FALSE(std::filesystem::exists(path("less.hgmm")));
}

TEST_F(MapForgetTool, OptionsStandAnywhere) {
    const std::string in = "'" + path("room.hgmm") + "'",
                      out = "'" + path("less.hgmm") + "'";
    for (const std::string& line : {"--box=9,9,9,10,10,10 " + in + " " + out + " --force",
                                    "--box 9,9,9,10,10,10 " + in + " " + out,
                                    "--force --box 9 9 9 10 10 10 " + in + " " + out,
                                    in + " --box=9,9,9,10,10,10 --force " + out}) {
        const Outcome outcome = mapTool("forget " + line);
        EXPECT_EQ(outcome.exitCode, 0) << line << outcome.err;
    }
}
