#include <algorithm>

#include "replay_map_fixture.h"

/// Pages and pictures that the Python package makes for the programs.
class PythonPages : public ReplayFolder {
 protected:
    void SetUp() override {
        ReplayFolder::SetUp();
        room_ = recordRoom(6, 1500);
    }
    /// The package of this build; false in builds without it, such as the sanitized ones.
    bool takePython() const {
        unsetenv("HGMM_PYTHON");
#ifdef HGMM_HAS_PYTHON
        return true;
#else
        return false;
#endif
    }
    bool exists(const std::string& name) const {
        return std::filesystem::exists(path(name));
    }
    void saveMap() const {
        ASSERT_EQ(replay(room_ + " --save-map " + path("room.hgmm")).exitCode, 0);
    }
    std::string room_;
};

TEST_F(PythonPages, WithoutPythonTheReportIsMetricsAlone) {
    std::filesystem::create_directory(path("r"));
    std::ofstream(path("r/report.html")) << "<!DOCTYPE html>\nof an earlier run\n";
    const Outcome outcome = replay(room_ + " --split 3 --quiet --report " + path("r"));
    EXPECT_EQ(outcome.exitCode, 0);
    expectHas(outcome.err, "report.html was not made (/nowhere/python3 cannot be started");
    EXPECT_EQ(std::count(outcome.err.begin(), outcome.err.end(), '\n'), 1) << outcome.err;
    EXPECT_FALSE(exists("r/report.html"));
    const auto json = metrics("r");
    EXPECT_EQ(json["maps"].size(), 1U);
    EXPECT_EQ(json["view"]["map"], "map.hgmm");
    EXPECT_EQ(json["view"]["points"], "input.ply");
    EXPECT_EQ(mapTool("check " + path("r/map.hgmm")).exitCode, 0);
    expectHas(content("r/input.ply"), "element vertex ");
}

TEST_F(PythonPages, TheReportHoldsTablesPlotsAndTheMap) {
    if (!takePython()) GTEST_SKIP() << "the Python package is not built";
    const Outcome outcome =
        replay(room_ + " --split 3 --quiet --baselines octomap:0.2 --report " + path("r"));
    EXPECT_EQ(outcome.exitCode, 0);
    EXPECT_EQ(outcome.err, "");
    const std::string page = content("r/report.html");
    for (const char* part : {"<!DOCTYPE html>", "octomap:0.2", "mrpt::maps::COctoMap",
                             "<svg", "<iframe", "hasPoints&quot;: true"})
        expectHas(page, part);
    expectHas(page, "poses&quot;: 6");
}

TEST_F(PythonPages, ViewMakesAPageBesideTheMap) {
    if (!takePython()) GTEST_SKIP() << "the Python package is not built";
    saveMap();
    const Outcome outcome =
        mapTool("view " + path("room.hgmm") + " --up=-y --poses " + path("room.tum"));
    ASSERT_EQ(outcome.exitCode, 0) << outcome.err;
    EXPECT_EQ(outcome.out, path("room.html") + "\n");
    expectHas(content("room.html"), "\"up\": \"-y\"");
    expectHas(content("room.html"), "\"poses\": 6");
}

TEST_F(PythonPages, PicturesArePng) {
    if (!takePython()) GTEST_SKIP() << "the Python package is not built";
    saveMap();
    const std::string map = path("room.hgmm"), picture = path("room.png");
    ASSERT_EQ(mapTool("export " + map + " " + picture + " --yaw=-20 --cut 0.2").exitCode,
              0);
    EXPECT_EQ(content("room.png").substr(0, 8), "\x89PNG\r\n\x1a\n");
    const Outcome refused = mapTool("export " + map + " " + picture + " --cut 1");
    EXPECT_EQ(refused.exitCode, 1);
    EXPECT_EQ(refused.err, "hgmm-map: --cut must be in [0, 1)\n");
}

TEST_F(PythonPages, WhatCannotBeMadeIsSaidAndLeavesNothing) {
    saveMap();
    const std::string map = path("room.hgmm");
    Outcome outcome = mapTool("view " + map);
    EXPECT_EQ(outcome.exitCode, 1);
    expectHas(outcome.err, "hgmm-map: /nowhere/python3 cannot be started");
    if (takePython()) {
        outcome = mapTool("view " + map + " --poses " + path("gone.tum"));
        EXPECT_EQ(outcome.exitCode, 1);
        EXPECT_EQ(outcome.err,
                  "hgmm-map: " + path("gone.tum") + ": No such file or directory\n");
    }
    EXPECT_FALSE(exists("room.html"));
    EXPECT_EQ(mapTool("view " + map + " --up w").exitCode, 2);
}
