#include "hgmm/evaluation/metrics_json.h"

#include <gtest/gtest.h>

#include <fstream>
#include <iterator>

#include "hgmm/evaluation/svg_plot.h"
#include "scratch_folder.h"

using namespace hgmm::evaluation;

namespace {

MapFigures exampleFigures() {
    MapFigures map;
    map.name = "hgmm";
    map.className = "mrpt::maps::CHGMMOccupancyMap";
    map.options = {{"levels", 5.0}};
    map.memory = {1000, 2000};
    map.scanTime_ms = {1.0, 2.0, 3.0, 4.0, 5.0};
    map.levels = {{0, 30, 1200, 0.0}, {1, 20, 800, 0.25}};
    return map;
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

class TextFile : public ScratchFolder {};

TEST_F(TextFile, AppearsWholeOrNotAtAll) {
    writeTextFile(path("a.json"), "first");
    writeTextFile(path("a.json"), "second");
    std::ifstream in(path("a.json"));
    EXPECT_EQ(std::string(std::istreambuf_iterator<char>(in), {}), "second");
    EXPECT_FALSE(std::filesystem::exists(path("a.json.partial")));
    EXPECT_THROW(writeTextFile(path("missing/a.json"), "x"), std::runtime_error);
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
