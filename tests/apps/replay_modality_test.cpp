#include "coloured_room.h"
#include "replay_map_fixture.h"

namespace {

class ReplayModality : public ReplayFolder {
 protected:
    /// "LOG --poses POSES" of a recording.
    std::string record(const box_room::Entries& entries) const {
        box_room::writeRawlog(path("room.rawlog"), entries);
        box_room::writePoses(path("room.tum"), entries.size());
        return "'" + path("room.rawlog") + "' --poses '" + path("room.tum") + "' --quiet";
    }
};

TEST_F(ReplayModality, ColoursAreReconstructedAndInferred) {
    const Outcome outcome = replay(record(coloured_room::withColours(4, 12000)) +
                                   " --study table5.1 --report " + path("report"));
    ASSERT_EQ(outcome.exitCode, 0) << outcome.err;
    expectHas(outcome.out, "study table5.1: room, 4 scans, 20 % of the points held out");
    const auto json = metrics("report");
    EXPECT_EQ(json["study"], "table5.1");
    EXPECT_EQ(json["modalities"], (nlohmann::json{"r", "g", "b"}));
    EXPECT_EQ(json["protocol"]["holdout_points"], 0.2);
    ASSERT_EQ(json["scans"].size(), 4U);
    for (const auto& scan : json["scans"]) {
        ASSERT_EQ(scan["modalities"].size(), 3U);
        for (const auto& modality : scan["modalities"]) {
            EXPECT_EQ(modality["points"], 2400);
            EXPECT_GT(modality["r2"], 0.95) << modality;
            EXPECT_GE(modality["known_share"], 0.9);
        }
        ASSERT_EQ(scan["cross_modal"].size(), 3U);
        for (const auto& cross : scan["cross_modal"]) {
            // 960 points of a whole room: what the other colours add is what counts.
            EXPECT_GT(cross["r2_inferred"], 0.5) << cross;
            EXPECT_GT(cross["r2_inferred"], cross["r2_regressed"]) << cross;
            EXPECT_LE(cross["r2_inferred"], 1.0);
        }
    }
    for (const auto& modality : json["sequence"]["modalities"]) {
        EXPECT_GT(modality["r2"], 0.95) << modality;
        EXPECT_GT(modality["bytes"], 0);
    }
    EXPECT_GT(json["insertion_ratio"], 0.5);
    EXPECT_GT(json["cross_modal_query_us"], 0.0);
    ASSERT_EQ(json["pictures"].size(), 5U) << "measured, reconstructed, three deviations";
    for (const auto& picture : json["pictures"])
        expectHas(
            content("report/" + picture["file"].get<std::string>()),
            picture.contains("scale") ? "property float value" : "property uchar red");
}

TEST_F(ReplayModality, FiguresAreTheSameForAnyNumberOfThreads) {
    const std::string command = record(coloured_room::withColours(2, 4000)) +
                                " --study table5.1 --report " + path("report");
    nlohmann::json figures[2];
    for (const int threads : {1, 2}) {
        ASSERT_EQ(replay(command + " --threads " + std::to_string(threads)).exitCode, 0);
        nlohmann::json json = metrics("report");
        for (auto& scan : json["scans"])
            for (auto& cross : scan["cross_modal"]) cross.erase("query_us");
        figures[threads - 1] = {json["scans"], json["sequence"]};
    }
    EXPECT_EQ(figures[0], figures[1]);
}

TEST_F(ReplayModality, IntensityIsTakenWhereThereAreNoColours) {
    const Outcome outcome = replay(record(coloured_room::withIntensities(3, 8000)) +
                                   " --study table5.1 --report " + path("report"));
    ASSERT_EQ(outcome.exitCode, 0) << outcome.err;
    const auto json = metrics("report");
    EXPECT_EQ(json["modalities"], nlohmann::json{"intensity"});
    EXPECT_GT(json["sequence"]["modalities"][0]["r2"], 0.95);
    EXPECT_FALSE(json["scans"][0].contains("cross_modal"));
    EXPECT_FALSE(json.contains("cross_modal_query_us"));
    EXPECT_EQ(outcome.out.find("inferred"), std::string::npos) << outcome.out;
}

TEST_F(ReplayModality, RecordingsWithoutAnyAreBadInput) {
    const Outcome outcome =
        replay(recordRoom(3, 500) + " --quiet --study table5.1 --report " + path("report"));
    EXPECT_EQ(outcome.exitCode, 1);
    expectHas(outcome.err, "room.rawlog: has neither colours nor intensities");
}

}  // namespace
