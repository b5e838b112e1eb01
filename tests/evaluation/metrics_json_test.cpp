#include "hgmm/evaluation/metrics_json.h"

#include <gtest/gtest.h>

#include "hgmm/evaluation/occupancy_plots.h"
#include "hgmm/evaluation/svg_plot.h"

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

/// Where the first circle of a drawing after `from` is.
std::pair<double, double> circleAt(const std::string& svg, std::size_t& from) {
    double x = 0, y = 0;
    from = svg.find("cx='", from);
    if (from != std::string::npos)
        std::sscanf(svg.c_str() + from++, "cx='%lf' cy='%lf'", &x, &y);
    return {x, y};
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

TEST(SvgPlot, CurvesStayInsideTheFrameAndAxesAreLabelled) {
    const std::string svg = toSvg({"a title",
                                   "size [components]",
                                   "KL < 1 & more [nat]",
                                   {{{{116, 2}, {300, 0}}, "mean", true}}});
    for (const char* part : {"a title", "size [components]", "KL &lt; 1 &amp; more [nat]",
                             "mean", "</svg>", ">200</text>", ">1</text>"})
        EXPECT_NE(svg.find(part), std::string::npos) << part;
    const std::size_t at = svg.find("points='");
    double x0 = 0, y0 = 0, x1 = 0, y1 = 0;
    ASSERT_EQ(std::sscanf(svg.c_str() + at, "points='%lf,%lf %lf,%lf", &x0, &y0, &x1, &y1),
              4);
    EXPECT_LT(x0, x1);
    EXPECT_LT(y0, y1) << "larger values are drawn higher, which is a smaller y";
    EXPECT_GT(x0, 80);
    EXPECT_LT(x1, 700);
    EXPECT_GT(y0, 40);
    EXPECT_LT(y1, 380);
}

TEST(SvgPlot, RefusesWhatCannotBeDrawn) {
    EXPECT_THROW(toSvg({"", "", "", {}}), std::invalid_argument);
    EXPECT_THROW(toSvg({"", "", "", {{{{0, std::nan("")}}, "", false}}}),
                 std::invalid_argument);
    EXPECT_NO_THROW(toSvg({"", "", "", {{{{5, 5}}, "", false}}}));
}

TEST(SvgPlot, DecadesAreEquallyLongOnALogarithmicAxis) {
    Plot plot;
    Curve curve;
    curve.markers = true;
    curve.points = {{10, 0}, {100, 1}, {10000, 2}};
    plot.curves = {curve};
    plot.xLogarithmic = true;
    const std::string svg = toSvg(plot);
    std::size_t at = 0;
    const double x10 = circleAt(svg, at).first, x100 = circleAt(svg, at).first,
                 x10000 = circleAt(svg, at).first;
    EXPECT_GT(x100, x10);
    EXPECT_NEAR(x10000 - x100, 2 * (x100 - x10), 0.01);
    EXPECT_NE(svg.find(">1000</text>"), std::string::npos);
    plot.curves[0].points.emplace_back(0.0, 1.0);
    EXPECT_THROW(toSvg(plot), std::invalid_argument);
}

TEST(OccupancyPlots, ShowEveryMap) {
    MapFigures ours = exampleFigures(), other = exampleFigures();
    ours.occupancy = exampleOccupancy();
    other.name = "octomap:0.05";
    other.levels.clear();
    other.occupancy = ours.occupancy;
    const Plot levels = levelsPlot({ours, other});
    ASSERT_EQ(levels.curves.size(), 2U);
    // The level that was not asked about occupancy is left out.
    using Points2 = std::vector<std::pair<double, double>>;
    EXPECT_EQ(levels.curves[0].points, (Points2{{1.2, 0.9}}));
    EXPECT_EQ(levels.curves[1].points, (Points2{{1.0, 0.9}})) << "as saved";
    other.memory.serialized_bytes.reset();
    EXPECT_EQ(levelsPlot({ours, other}).curves[1].points, (Points2{{2.0, 0.9}}))
        << "as held, where it cannot be saved";
    EXPECT_EQ(reliabilityPlot({ours}).curves.back().points,
              (Points2{{0.1, 0.2}, {0.9, 0.7}}));
    for (const Plot& plot :
         {levels, rocPlot({ours, other}), reliabilityPlot({ours, other})}) {
        const std::string svg = toSvg(plot);
        EXPECT_NE(svg.find("hgmm"), std::string::npos);
        EXPECT_NE(svg.find("octomap:0.05"), std::string::npos);
    }
}
