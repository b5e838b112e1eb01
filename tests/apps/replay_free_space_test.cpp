#include "replay_map_fixture.h"

/// Study free-space: the thesis' own model beside the default.
using ReplayFreeSpace = ReplayFolder;

TEST_F(ReplayFreeSpace, BothModelsAreEvaluatedOnTheSameScans) {
    const std::string room = recordRoom(8, 2000) + " --split 4 --report ";
    const Outcome outcome = replay(room + path("both") + " --study free-space");
    ASSERT_EQ(outcome.exitCode, 0) << outcome.err;
    expectHas(replay("--list-studies").out, "free-space");
    const auto json = metrics("both");
    ASSERT_EQ(json["maps"].size(), 2U);
    const auto &slabs = json["maps"][0], &thesis = json["maps"][1];
    EXPECT_EQ(slabs["name"], "slabs");
    EXPECT_EQ(thesis["name"], "perComponent");
    EXPECT_EQ(thesis["class"], "ThesisFreeSpace");
    EXPECT_EQ(slabs["hits"], thesis["hits"]);
    for (const auto& map : json["maps"]) {
        expectHas(outcome.out, map["name"]);
        EXPECT_GT(map["auc_uniform"], 0.9);
        EXPECT_GT(map["bytes_serialized"], 0);
    }

    // The default is what a plain replay builds.
    ASSERT_EQ(replay(room + path("plain")).exitCode, 0);
    const auto plain = metrics("plain")["maps"][0];
    EXPECT_EQ(plain["auc_near"], slabs["auc_near"]);
    EXPECT_EQ(plain["bytes_serialized"], slabs["bytes_serialized"]);
}

TEST_F(ReplayFreeSpace, BaselinesComeLastAndOnce) {
    const Outcome outcome =
        replay(recordRoom(4, 500) + " --split 2 --baselines octomap:0.4 --report " +
               path("both") + " --study free-space");
    ASSERT_EQ(outcome.exitCode, 0) << outcome.err;
    const auto json = metrics("both");
    ASSERT_EQ(json["maps"].size(), 3U);
    EXPECT_EQ(json["maps"][2]["name"], "octomap:0.4");
}

TEST_F(ReplayFreeSpace, NeedsTestPoints) {
    const std::string room = recordRoom(3, 500);
    EXPECT_EQ(replay(room + " --study free-space").exitCode, 2);
    const Outcome none = replay(room + " --split 100 --study free-space");
    EXPECT_EQ(none.exitCode, 1);
    expectHas(none.err, "no test points");
}
