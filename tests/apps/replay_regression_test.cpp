#include <cmath>

#include "replay_map_fixture.h"

/// Study fig4.5: the variance of a noisy sine, thesis 4.4.4.
using ReplayRegression = ReplayFolder;

TEST_F(ReplayRegression, IsListed) {
    expectHas(replay("--list-studies").out, "fig4.5");
}

TEST_F(ReplayRegression, VarianceAndEntropyConvergeForTheDefaultSeed) {
    const Outcome outcome = replay("--study fig4.5 --report " + path("report"));
    ASSERT_EQ(outcome.exitCode, 0) << outcome.err;
    expectHas(outcome.out, "thesis: 14");
    const auto json = metrics("report");
    ASSERT_EQ(json["steps"].size(), 25U);
    const auto last = json["steps"].back();
    EXPECT_EQ(last["sets"], 25);
    const double entropyOfNoise = 0.5 * std::log(2 * M_PI * M_E * 0.0025);
    EXPECT_NEAR(double(last["mixture"]["variance"]), 0.0025, 0.15 * 0.0025);
    EXPECT_NEAR(double(last["mixture"]["entropy_nat"]), double(last["gp"]["entropy_nat"]),
                0.1);
    // The GP is the yardstick: 12500 samples tell the variance of the noise to 1.3 %.
    EXPECT_NEAR(double(last["gp"]["variance"]), 0.0025, 0.05 * 0.0025);
    EXPECT_NEAR(double(last["gp"]["entropy_nat"]), entropyOfNoise, 0.025);
    EXPECT_LT(double(last["mixture"]["rmse"]), 0.015);
    EXPECT_LT(double(last["gp"]["rmse"]), 0.005);

    // The size is estimated: well below the overestimate, and not the same for all seeds.
    EXPECT_LT(int(json["components"]), int(json["overestimate"]));
    ASSERT_EQ(json["seeds"].size(), 20U);
    EXPECT_EQ(json["seeds"][0]["components"], json["components"]);
    int held = 0;
    bool differ = false;
    for (const auto& seed : json["seeds"]) {
        held += seed["holds"] == true ? 1 : 0;
        differ = differ || seed["components"] != json["components"];
    }
    EXPECT_EQ(held, 20);
    EXPECT_TRUE(differ);
    EXPECT_EQ(json["plots"].size(), 6U);
}

TEST_F(ReplayRegression, FollowsTheSeedAndNothingElse) {
    const Outcome one = replay("--study fig4.5 --seed 7 --threads 1");
    ASSERT_EQ(one.exitCode, 0) << one.err;
    EXPECT_EQ(one.out, replay("--study fig4.5 --seed 7 --threads 2").out);
    EXPECT_NE(one.out, replay("--study fig4.5 --seed 8").out);
}

TEST_F(ReplayRegression, TakesNoRecording) {
    const Outcome outcome = replay(path("any.rawlog") + " --study fig4.5");
    EXPECT_EQ(outcome.exitCode, 2);
    expectHas(outcome.err, "no LOG");
}
