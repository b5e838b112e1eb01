#include "hgmm/evaluation/metrics_json.h"

#include <gtest/gtest.h>

#include <cmath>

#include "hgmm/evaluation/plot.h"

using namespace hgmm::evaluation;

namespace {

MapFigures exampleFigures() {
    MapFigures map;
    map.name = "hgmm";
    map.className = "mrpt::maps::CHGMMOccupancyMap";
    map.options = {{"levels", 5.0}};
    map.memory = {1000, 2000};
    map.scanTime_ms = {1.0, 2.0, 3.0, 4.0, 5.0};
    map.levels = {{0, 30, 40, 1200, 0.0, 0.98, 0.9}, {1, 20, 25, 800, 0.25, {}, {}}};
    return map;
}

OccupancyFigures exampleOccupancy() {
    OccupancyFigures f;
    f.hits = 10;
    f.uniformFree = 9;
    f.nearFree = 8;
    f.rocUniform = {{0.0, 0.0}, {0.0, 0.8}, {1.0, 0.8}, {1.0, 1.0}};
    f.rocNear = {{0.0, 0.0}, {1.0, 1.0}};
    f.aucUniform = 0.99;
    f.aucNear = 0.9;
    f.balancedAccuracyNear = 0.85;
    f.brier = 0.1;
    f.logLoss = 0.4;
    f.reliability = {{0.1, 0.2}, {0.9, 0.7}};
    f.ece = 0.03;
    f.unknownShareHit = 0.01;
    f.unknownShareFree = 0.02;
    f.unknownShareNear = 0.04;
    f.queriesPerSecond = 1e6;
    return f;
}

}  // namespace

TEST(MetricsJson, HoldsWhatWasMeasuredUnderTheNamesOfTheSchema) {
    hgmm::evaluation::Run run;
    run.dataset = "room";
    run.sensor = "mrpt::obs::CObservationPointCloud";
    run.scansMapped = 9;
    run.scansTested = 3;
    run.pointsPerScan = 400.0;
    run.split.every = 4;
    run.split.seed = 17;
    run.queriesPerScan = 2000;
    run.threads = 2;
    run.nearBand = {0.05, 0.3};
    run.freeBand = {0.0, 0.2};
    MapFigures map = exampleFigures();
    map.logLikelihoodOfHits = -1.5;
    map.reconstruction = Reconstruction{0.01, 0.03, 0.02, 0.9, 0.8, 0.85};
    const auto json = metricsJson(run, {map});
    EXPECT_EQ(json["dataset"]["name"], "room");
    EXPECT_EQ(json["dataset"]["scans_mapped"], 9);
    EXPECT_EQ(json["dataset"]["scans_tested"], 3);
    EXPECT_EQ(json["dataset"]["points_per_scan"], 400.0);
    EXPECT_EQ(json["dataset"]["sensor"], "mrpt::obs::CObservationPointCloud");
    EXPECT_FALSE(json["dataset"].contains("interrupted"));
    EXPECT_EQ(json["protocol"]["split"], 4);
    EXPECT_EQ(json["protocol"]["seed"], 17);
    EXPECT_EQ(json["protocol"]["queries_per_scan"], 2000);
    EXPECT_EQ(json["protocol"]["threads"], 2);
    EXPECT_EQ(json["protocol"]["near_m"], nlohmann::ordered_json({0.05, 0.3}));
    EXPECT_EQ(json["protocol"]["free_band_m"], nlohmann::ordered_json({0.0, 0.2}));
    const auto& m = json["maps"].at(0);
    EXPECT_EQ(m["options"]["levels"], 5.0);
    EXPECT_EQ(m["loglik_hit"], -1.5);
    EXPECT_EQ(m["accuracy_m"], 0.01);
    EXPECT_EQ(m["completeness_m"], 0.03);
    EXPECT_EQ(m["chamfer_m"], 0.02);
    EXPECT_EQ(m["f1_5cm"], 0.85);
    EXPECT_EQ(m["bytes_serialized"], 1000);
    EXPECT_EQ(m["bytes_live"], 2000);
    EXPECT_EQ(m["components_surface"], 30);
    EXPECT_EQ(m["components_free"], 40);
    EXPECT_EQ(m["scan_ms_median"], 1.0);
    EXPECT_EQ(m["scan_ms_p99"], 2.0);
    EXPECT_EQ(m["scan_ms_worst"], 3.0);
    EXPECT_EQ(m["scan_ms_first_tenth"], 4.0);
    EXPECT_EQ(m["scan_ms_last_tenth"], 5.0);
    ASSERT_EQ(m["levels"].size(), 2U);
    EXPECT_EQ(m["levels"][1]["level"], 1);
    EXPECT_EQ(m["levels"][1]["components"], 20);
    EXPECT_EQ(m["levels"][1]["bytes"], 800);
    EXPECT_EQ(m["levels"][1]["kl_to_level0"], 0.25);
    EXPECT_EQ(m["levels"][1]["components_free"], 25);
    EXPECT_EQ(m["levels"][0]["auc_uniform"], 0.98);
    EXPECT_EQ(m["levels"][0]["auc_near"], 0.9);
    EXPECT_FALSE(m["levels"][1].contains("auc_near"));
}

TEST(MetricsJson, OccupancyUnderTheNamesOfTheSchema) {
    MapFigures map = exampleFigures();
    map.occupancy = exampleOccupancy();
    const auto json = metricsJson({}, {map});
    const auto& m = json["maps"].at(0);
    EXPECT_EQ(m["auc_uniform"], 0.99);
    EXPECT_EQ(m["auc_near"], 0.9);
    EXPECT_DOUBLE_EQ(m["tpr_at_fpr_1pct"], 0.8);
    EXPECT_DOUBLE_EQ(m["tpr_at_fpr_5pct"], 0.8);
    EXPECT_DOUBLE_EQ(m["tpr_at_fpr_1pct_near"], 0.01);
    EXPECT_DOUBLE_EQ(m["tpr_at_fpr_5pct_near"], 0.05);
    EXPECT_EQ(m["balanced_accuracy_near"], 0.85);
    EXPECT_EQ(m["brier"], 0.1);
    EXPECT_EQ(m["log_loss"], 0.4);
    EXPECT_EQ(m["ece"], 0.03);
    EXPECT_EQ(m["unknown_share_hit"], 0.01);
    EXPECT_EQ(m["unknown_share_free"], 0.02);
    EXPECT_EQ(m["unknown_share_near"], 0.04);
    EXPECT_EQ(m["queries_per_s"], 1e6);
    EXPECT_EQ(m["hits"], 10);
    EXPECT_EQ(m["uniform_free_points"], 9);
    EXPECT_EQ(m["near_free_points"], 8);
    EXPECT_EQ(m["roc"],
              nlohmann::ordered_json::parse("[[0.0,0.0],[0.0,0.8],[1.0,0.8],[1.0,1.0]]"));
    EXPECT_EQ(m["roc_near"], nlohmann::ordered_json::parse("[[0.0,0.0],[1.0,1.0]]"));
    EXPECT_EQ(m["reliability"], nlohmann::ordered_json::parse("[[0.1,0.2],[0.9,0.7]]"));
}

TEST(MetricsJson, UnseenSpaceUnderTheNamesOfTheProtocol) {
    MapFigures map = exampleFigures();
    EXPECT_FALSE(metricsJson({}, {map})["maps"][0].contains("unseen_called_occupied"));
    map.unseen = UnseenFigures{7, 8, 9, 0.1, 0.2, 0.3, 0.4, 0.5};
    const auto json = metricsJson({}, {map})["maps"][0];
    EXPECT_EQ(json["unseen_points_behind_hits"], 7);
    EXPECT_EQ(json["unseen_points_in_box"], 8);
    EXPECT_EQ(json["seen_points"], 9);
    EXPECT_EQ(json["unseen_called_free_behind_hits"], 0.1);
    EXPECT_EQ(json["unseen_called_free_in_box"], 0.2);
    EXPECT_EQ(json["unseen_called_occupied"], 0.3);
    EXPECT_EQ(json["unseen_mean_p_unknown"], 0.4);
    EXPECT_EQ(json["seen_called_unknown"], 0.5);
}

TEST(MetricsJson, OtherMapsHaveNoComponentsAndNoSavedSize) {
    MapFigures map = exampleFigures();
    map.levels.clear();
    map.memory.serialized_bytes.reset();
    const auto json = metricsJson({}, {exampleFigures(), map});
    ASSERT_EQ(json["maps"].size(), 2U);
    for (const char* key : {"bytes_serialized", "components_surface", "components_free"})
        EXPECT_FALSE(json["maps"][1].contains(key)) << key;
    EXPECT_EQ(json["maps"][1]["bytes_live"], 2000);
}

TEST(MetricsJson, WhatWasNotMeasuredIsLeftOut) {
    hgmm::evaluation::Run run;
    run.interrupted = true;
    const auto json = metricsJson(run, {exampleFigures()});
    for (const char* key : {"loglik_hit", "accuracy_m", "f1_5cm", "likelihoods_per_s"})
        EXPECT_FALSE(json["maps"][0].contains(key)) << key;
    EXPECT_EQ(json.dump().find("null"), std::string::npos);
    EXPECT_EQ(json["dataset"]["interrupted"], true);
}

TEST(MetricsJson, RatesForALogarithmicAxisAreThoseOfTheWholeCurve) {
    MapFigures map = exampleFigures();
    map.occupancy = exampleOccupancy();
    map.occupancy->rocUniform = {{0.0, 0.0}, {0.0, 0.5}, {0.002, 0.6}, {1.0, 1.0}};
    const auto rates = metricsJson({}, {map})["maps"][0]["tpr_at_log_fpr"];
    ASSERT_EQ(rates.size(), 101U);
    EXPECT_DOUBLE_EQ(rates[0][0], 1e-4);
    EXPECT_DOUBLE_EQ(rates[0][1], 0.505) << "a thinned curve would have lost this corner";
    EXPECT_NEAR(rates[50][0], 0.01, 1e-12);
    EXPECT_NEAR(rates[50][1], 0.6 + 0.4 * 0.008 / 0.998, 1e-12);
    EXPECT_EQ(rates[100], nlohmann::ordered_json({1.0, 1.0}));
}

TEST(PlotJson, HoldsTheCurvesInTheirOrder) {
    const auto json =
        plotJson({"a title", "x [m]", "y", {{{{1, 2}, {3, 4}}, "mean", true}, {}}});
    EXPECT_EQ(json["title"], "a title");
    EXPECT_EQ(json["x_label"], "x [m]");
    EXPECT_EQ(json["curves"][0]["points"],
              nlohmann::ordered_json::parse("[[1.0,2.0],[3.0,4.0]]"));
    EXPECT_EQ(json["curves"][0]["emphasised"], true);
    EXPECT_EQ(json["curves"][1]["label"], "");
}

TEST(PlotJson, RefusesWhatCannotBeDrawn) {
    EXPECT_THROW(plotJson({"", "", "", {}}), std::invalid_argument);
    EXPECT_THROW(plotJson({"", "", "", {{{{0, std::nan("")}}, "", false}}}),
                 std::invalid_argument);
    EXPECT_NO_THROW(plotJson({"", "", "", {{{{5, 5}}, "", false}}}));
}
