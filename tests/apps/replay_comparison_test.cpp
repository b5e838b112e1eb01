#include <regex>

#include "replay_map_fixture.h"

/// Studies that compare maps of one run.
class ReplayComparison : public ReplayFolder {
 protected:
    Outcome study(const std::string& name, const std::string& more = "") const {
        return replay(recordRoom() + " --split 4 --study " + name + " --report " +
                      path("report") + more);
    }
    nlohmann::json namesOfMaps() const {
        nlohmann::json names;
        const nlohmann::json json = metrics("report");
        for (const auto& map : json["maps"]) names.push_back(map["name"]);
        return names;
    }
};

TEST_F(ReplayComparison, Fig35ScoresSurfacesByLikelihood) {
    const Outcome outcome = study("fig3.5");
    ASSERT_EQ(outcome.exitCode, 0) << outcome.err;
    EXPECT_EQ(namesOfMaps(),
              nlohmann::json({"hgmm surface", "ndt:0.2", "ndt:0.4", "ndt:0.6"}));
    const nlohmann::json json = metrics("report");
    for (const auto& map : json["maps"]) {
        EXPECT_EQ(map["score"], "surface_likelihood");
        EXPECT_EQ(map["ranked"], false);
        EXPECT_GT(map["auc_uniform"], 0.9) << map["name"];
        EXPECT_FALSE(map.contains("brier")) << "a likelihood is no probability";
        expectHas(outcome.out, map["name"]);
    }
    EXPECT_GT(json["maps"][0]["auc_near"], 0.97);
}

TEST_F(ReplayComparison, Fig41ComparesOccupancy) {
    ASSERT_EQ(study("fig4.1").exitCode, 0);
    EXPECT_EQ(namesOfMaps(),
              nlohmann::json({"hgmm", "octomap:0.3", "ndt-om:0.4", "gpoctomap:0.3"}));
    const nlohmann::json json = metrics("report");
    for (const auto& map : json["maps"]) {
        EXPECT_EQ(map["ranked"], true);
        EXPECT_GT(map["auc_uniform"], 0.8) << map["name"];
        EXPECT_FALSE(map["source"].get<std::string>().empty());
    }
    ASSERT_EQ(study("fig4.1", " --baselines nn").exitCode, 0);
    EXPECT_EQ(namesOfMaps(), nlohmann::json({"hgmm", "nn"})) << "the user's own come first";
}

TEST_F(ReplayComparison, Fig42ShowsEachLevel) {
    const Outcome outcome = study("fig4.2");
    ASSERT_EQ(outcome.exitCode, 0);
    const auto levels = metrics("report")["maps"][0]["levels"];
    ASSERT_GT(levels.size(), 2U);
    for (const auto& level : levels)
        EXPECT_TRUE(std::regex_search(outcome.out,
                                      std::regex("\n +" + level["level"].dump() + " +" +
                                                 level["components"].dump() + " ")))
            << level << outcome.out;
}

TEST_F(ReplayComparison, Table41ComparesMemory) {
    const Outcome outcome =
        replay(recordRoom() + " --study table4.1 --baselines octomap:0.1 " + "--report " +
               path("report"));
    ASSERT_EQ(outcome.exitCode, 0) << outcome.err;
    const auto maps = metrics("report")["maps"];
    std::smatch row;
    ASSERT_TRUE(std::regex_search(
        outcome.out, row, std::regex("octomap:0.1 +([0-9.]+) +([0-9.]+) +([0-9.]+)")));
    EXPECT_NEAR(std::stod(row[1]), double(maps[1]["bytes_live"]) / 1000, 0.06);
    EXPECT_NEAR(std::stod(row[2]), std::stod(row[1]) / 12, 0.001 + 0.05 / 12);
    EXPECT_NEAR(std::stod(row[3]),
                double(maps[1]["bytes_live"]) / double(maps[0]["bytes_serialized"]), 0.06);
}

TEST_F(ReplayComparison, Fig38ShowsTheVoxelsOfEachMap) {
    const Outcome outcome = study("fig3.8");
    ASSERT_EQ(outcome.exitCode, 0) << outcome.err;
    const nlohmann::json pictures = metrics("report")["pictures"];
    ASSERT_EQ(pictures.size(), 5U) << "the input and four maps";
    EXPECT_FALSE(pictures[0].contains("edge_m"));
    for (std::size_t i = 1; i < 5; ++i) {
        EXPECT_EQ(pictures[i]["edge_m"], 0.2);
        const std::string text = pictures[i]["caption"];
        expectHas(content("report/" + pictures[i]["file"].get<std::string>()),
                  "element vertex " + text.substr(0, text.find(' ')) + "\n");
    }
    std::smatch row;
    ASSERT_TRUE(std::regex_search(
        outcome.out, row,
        std::regex("hgmm +([0-9]+) voxels; ([0-9.]+) of the measured.*, ([0-9.]+) of")));
    EXPECT_GT(std::stod(row[2]), 0.95) << outcome.out;
    EXPECT_GT(std::stod(row[3]), 0.9) << outcome.out;
}

TEST_F(ReplayComparison, RealtimeCountsScansPerSecond) {
    const Outcome outcome = study("realtime");
    ASSERT_EQ(outcome.exitCode, 0);
    std::smatch rate;
    ASSERT_TRUE(std::regex_search(
        outcome.out, rate, std::regex("([0-9.]+) scans/s; a scan takes ([0-9.]+) ms")));
    EXPECT_NEAR(std::stod(rate[1]) * std::stod(rate[2]), 1000.0, 20.0);
}

TEST_F(ReplayComparison, NeedsTestPoints) {
    for (const char* name : {"fig3.5", "fig3.8", "fig4.1", "fig4.2"})
        EXPECT_EQ(replay(recordRoom(2, 200) + " --study " + name).exitCode, 2) << name;
}
