#include "replay_map_fixture.h"

using Replay = ReplayFolder;

TEST_F(Replay, FiguresOfABoxRoomArePlausible) {
    const Outcome outcome = replay(recordRoom() + " --split 4 --report " + path("report") +
                                   " --save-map " + path("m.hgmm"));
    ASSERT_EQ(outcome.exitCode, 0) << outcome.err;
    expectHas(outcome.out, "9 scans mapped, 3 tested");
    expectHas(outcome.out, "F1 at 5 cm");
    EXPECT_TRUE(std::filesystem::exists(path("m.hgmm")));

    const auto json = metrics("report");
    EXPECT_EQ(json["dataset"]["name"], "room");
    EXPECT_EQ(json["dataset"]["scans_mapped"], 9);
    EXPECT_EQ(json["dataset"]["scans_tested"], 3);
    EXPECT_EQ(json["dataset"]["points_per_scan"], 3000.0);
    EXPECT_EQ(json["protocol"]["split"], 4);
    const auto& map = json["maps"].at(0);
    EXPECT_EQ(map["class"], "mrpt::maps::CHGMMOccupancyMap");
    // Six walls: flat, so few components reproduce them to a few centimetres.
    EXPECT_GE(map["components_surface"], 6);
    EXPECT_LE(map["components_surface"], 3000);
    EXPECT_EQ(map["levels"][0]["components"], map["components_surface"]);
    EXPECT_LT(map["accuracy_m"], 0.15);
    EXPECT_LT(map["completeness_m"], 0.10);
    EXPECT_GT(map["f1_5cm"], 0.3);
    // Points spread evenly over 132 m^2 of walls, Gaussian across with 2 cm, have -3.1 nat.
    EXPECT_GT(map["loglik_hit"], -6.0);
    EXPECT_LT(map["loglik_hit"], 0.0);
    EXPECT_GT(map["bytes_serialized"], 16 * int(map["components_surface"]));
    EXPECT_GT(map["bytes_live"], map["levels"][0]["bytes"]);
    EXPECT_GT(map["scan_ms_median"], 0.0);
    EXPECT_LE(map["scan_ms_median"], map["scan_ms_p99"]);
    EXPECT_LE(map["scan_ms_p99"], map["scan_ms_worst"]);
    EXPECT_GT(map["options"].size(), 5U);
}

TEST_F(Replay, WrongPosesGiveAWorseMap) {
    const std::string good = recordRoom();
    ASSERT_EQ(replay(good + " --split 4 --report " + path("good")).exitCode, 0);
    hgmm::evaluation::Trajectory wrong;
    for (std::size_t i = 0; i < 12; ++i)
        wrong.push_back({box_room::timeOfScan(i), hgmm::Pose{}});
    hgmm::evaluation::writeTumTrajectory(path("wrong.tum"), wrong);
    ASSERT_EQ(replay("'" + path("room.rawlog") + "' --poses " + path("wrong.tum") +
                     " --split 4 --report " + path("wrong"))
                  .exitCode,
              0);
    EXPECT_GT(metrics("good")["maps"][0]["loglik_hit"],
              double(metrics("wrong")["maps"][0]["loglik_hit"]) + 0.3);
}

TEST_F(Replay, RunsAreReproducibleExceptForTimes) {
    const std::string command =
        recordRoom() + " --split 4 --subsample 0.5 --holdout-points 0.1 --seed 5";
    const std::string besides =
        " --baselines octomap:0.1,grid3d:0.1,ndt,ndt-om,gpoctomap,nn";
    const auto withoutTimes = [&](const std::string& folder) {
        EXPECT_EQ(replay(command + besides + " --report " + path(folder)).exitCode, 0);
        nlohmann::json json = metrics(folder);
        EXPECT_EQ(json["maps"].size(), 7U);
        EXPECT_EQ(json["maps"][0].erase("likelihoods_per_s"), 1U);
        for (auto& map : json["maps"])
            for (const char* key :
                 {"scan_ms", "scan_ms_median", "scan_ms_p99", "scan_ms_worst",
                  "scan_ms_first_tenth", "scan_ms_last_tenth", "queries_per_s"})
                EXPECT_EQ(map.erase(key), 1U) << key;
        return json;
    };
    const nlohmann::json first = withoutTimes("a");
    EXPECT_EQ(first, withoutTimes("b"));
    ASSERT_EQ(replay(command + "1 --report " + path("c")).exitCode, 0);
    EXPECT_NE(first["maps"][0]["loglik_hit"], metrics("c")["maps"][0]["loglik_hit"])
        << "another seed holds out other points";
}

/// The C library has other code for other processors, whose last bits differ.
TEST_F(Replay, TheMapAndItsAnswersDoNotDependOnWhatTheCLibraryPicks) {
    const std::string command = recordRoom() + " --split 4 --save-map ";
    std::ofstream points(path("points.csv"));
    points << "x,y,z\n";
    for (int k = 0; k < 500; ++k)
        points << 0.01 * (k * 37 % 500) - 2 << ',' << 0.01 * (k * 91 % 400) - 2 << ','
               << 0.004 * k << '\n';
    points.close();
    const auto answers = [&](const std::string& name) {
        EXPECT_EQ(replay(command + path(name + ".hgmm")).exitCode, 0);
        const Outcome query = mapTool("query '" + path(name + ".hgmm") + "' --points '" +
                                      path("points.csv") + "' --out '" + path(name) + "'");
        EXPECT_EQ(query.exitCode, 0) << query.err;
        return content(name);
    };
    const std::string first = answers("first");
    ASSERT_EQ(setenv("GLIBC_TUNABLES", "glibc.cpu.hwcaps=-AVX2,-FMA,-AVX512F", 1), 0);
    const std::string second = answers("second");
    unsetenv("GLIBC_TUNABLES");
    EXPECT_GT(first.size(), 10000U);
    EXPECT_EQ(first, second);
    EXPECT_EQ(content("first.hgmm"), content("second.hgmm"));
}

TEST_F(Replay, TheMapDoesNotDependOnTheNumberOfThreads) {
    const std::string command = recordRoom() + " --split 4 --save-map ";
    ASSERT_EQ(replay(command + path("one.hgmm") + " --threads 1").exitCode, 0);
    ASSERT_EQ(replay(command + path("two.hgmm") + " --threads 2").exitCode, 0);
    ASSERT_FALSE(content("one.hgmm").empty());
    EXPECT_TRUE(content("one.hgmm") == content("two.hgmm"));
}

TEST_F(Replay, HeldOutPointsTestTheMapWithoutASplit) {
    const Outcome outcome =
        replay(recordRoom() + " --holdout-points 0.1 --report " + path("report"));
    ASSERT_EQ(outcome.exitCode, 0) << outcome.err;
    const auto json = metrics("report");
    EXPECT_EQ(json["dataset"]["scans_tested"], 0);
    EXPECT_EQ(json["dataset"]["scans_mapped"], 12);
    EXPECT_TRUE(json["maps"][0].contains("f1_5cm"));
}

TEST_F(Replay, WithoutTestPointsAccuracyIsLeftOut) {
    const Outcome outcome = replay(recordRoom() + " --report " + path("report"));
    ASSERT_EQ(outcome.exitCode, 0) << outcome.err;
    EXPECT_FALSE(metrics("report")["maps"][0].contains("f1_5cm"));
    expectHas(outcome.out, "--split");
}

TEST_F(Replay, ProgressIsPlainLinesOrNothing) {
    const std::string command = recordRoom();
    const Outcome plain = replay(command);
    expectHas(plain.err, "12/12 scans");
    EXPECT_EQ(plain.err.find('\r'), std::string::npos);
    EXPECT_EQ(replay(command + " --quiet").err, "");
}

TEST_F(Replay, ConfigurationReachesTheMap) {
    std::ofstream(path("good.ini")) << "[map]\nhgmmMap_count = 1\n"
                                       "[map_hgmmMap_00_insertOpts]\nlevels = 3\n";
    const std::string room = recordRoom();
    const Outcome good =
        replay(room + " --config " + path("good.ini") + " --report " + path("report"));
    ASSERT_EQ(good.exitCode, 0) << good.err;
    EXPECT_EQ(metrics("report")["maps"][0]["options"]["levels"], 3);
    EXPECT_EQ(metrics("report")["maps"][0]["levels"].size(), 3U);

    std::ofstream(path("bad.ini")) << "[map]\nhgmmMap_count = 1\n"
                                      "[map_hgmmMap_00_insertOpts]\nlevels = -3\n";
    const Outcome bad = replay(room + " --config " + path("bad.ini"));
    EXPECT_EQ(bad.exitCode, 1);
    expectHas(bad.err, "levels");
    std::ofstream(path("none.ini")) << "[map]\npointsMap_count = 1\n";
    const Outcome none = replay(room + " --config " + path("none.ini"));
    EXPECT_EQ(none.exitCode, 1);
    expectHas(none.err, "none.ini: describes 0 hgmm maps");
}

TEST_F(Replay, TheTelecomLogReplaysOnItsOdometry) {
    const std::string log =
        "/usr/share/mrpt/datasets/2006-01ENE-21-SENA_Telecom Faculty_one_loop_only.rawlog";
    if (!std::filesystem::exists(log))
        GTEST_SKIP() << "SKIPPED: mrpt-common is not installed";
    const Outcome outcome = replay("'" + log + "' --split 5 --report " + path("report"));
    ASSERT_EQ(outcome.exitCode, 0) << outcome.err;
    const auto json = metrics("report");
    EXPECT_EQ(int(json["dataset"]["scans_mapped"]) + int(json["dataset"]["scans_tested"]),
              225);
    EXPECT_EQ(json["dataset"]["sensor"], "mrpt::obs::CObservation2DRangeScan");
}

TEST_F(Replay, ScansOutOfRangeAreReportedOnce) {
    std::ofstream(path("near.ini")) << "[map]\nhgmmMap_count=1\n"
                                       "[map_hgmmMap_00_insertOpts]\nmaxRange_m = 0.2\n";
    const Outcome outcome =
        replay(recordRoom(4, 500) + " --config " + path("near.ini") + " --quiet");
    const std::string text = "all points of a scan are farther than maxRange_m = 0.2";
    expectHas(outcome.err, text);
    EXPECT_EQ(outcome.err.find(text), outcome.err.rfind(text)) << outcome.err;
}
