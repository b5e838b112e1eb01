#include <mrpt/maps/CHGMMOccupancyMap.h>

#include <filesystem>

#include "replay_map_fixture.h"

class MapCheck : public ReplayFolder {
 protected:
    void SetUp() override {
        ReplayFolder::SetUp();
        ASSERT_EQ(replay(recordRoom(3, 400) + " --save-map " + path("m.hgmm")).exitCode, 0);
    }
    void expectBad(const std::string& file, const std::string& what) const {
        const Outcome outcome = mapTool("check " + file);
        EXPECT_EQ(outcome.exitCode, 1) << file;
        expectHas(outcome.err, file + ": ");
        expectHas(outcome.err, what);
        EXPECT_EQ(outcome.out, "");
    }
};

TEST_F(MapCheck, WholeMapsAreGood) {
    const Outcome outcome = mapTool("check " + path("m.hgmm"));
    EXPECT_EQ(outcome.exitCode, 0) << outcome.err;
    expectHas(outcome.out, "m.hgmm: good, format version 4, ");
}

TEST_F(MapCheck, WhatARobotShouldNotHaveIsSaid) {
    expectBad(path("none.hgmm"), "no such file");
    expectBad(path("room.tum"), "not a saved map");
    expectBad(HGMM_SAVED_MAPS "/map_v1.hgmm", "free space is a guess");
    mrpt::maps::CHGMMOccupancyMap().saveToFile(path("empty.hgmm"));
    expectBad(path("empty.hgmm"), "the map is empty");
    std::string bytes = content("m.hgmm");
    bytes[bytes.size() / 2] = static_cast<char>(bytes[bytes.size() / 2] ^ 1);
    std::ofstream(path("flipped.hgmm"), std::ios::binary) << bytes;
    expectBad(path("flipped.hgmm"), "");
}

TEST_F(MapCheck, AllFilesAreLookedAt) {
    const Outcome outcome =
        mapTool("check " + path("none.hgmm") + " " + path("m.hgmm") + " " + path("gone"));
    EXPECT_EQ(outcome.exitCode, 1);
    expectHas(outcome.out, "m.hgmm: good");
    expectHas(outcome.err, "none.hgmm: ");
    expectHas(outcome.err, "gone: ");
}
