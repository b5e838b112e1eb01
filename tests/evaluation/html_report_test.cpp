#include "hgmm/evaluation/html_report.h"

#include <gtest/gtest.h>

#include <cmath>
#include <regex>
#include <set>
#include <sstream>

namespace hgmm::evaluation {
namespace {

MapFigures exampleMap(const std::string& name, double auc, double brier) {
    MapFigures map;
    map.name = name;
    map.className = "class::of::" + name;
    map.source = "Paper about " + name;
    map.options = {{"resolution_m", 0.05}};
    OccupancyFigures f;
    f.aucUniform = f.aucNear = f.balancedAccuracyNear = auc;
    f.brier = f.ece = brier;
    f.rocNear = f.rocUniform = {{0, 0}, {0.1, auc}, {1, 1}};
    f.reliability = {{0.1, 0.2}, {0.5, 0.4}, {0.9, 0.7}};
    f.queriesPerSecond = 1000 * auc;
    map.occupancy = f;
    map.memory = {std::nullopt, 2000000};
    map.insert_ms = {10, 12, 11};
    map.scanTime_ms = summariseTimes(map.insert_ms);
    map.liveBytesOverRun = {{1, 1000000}, {3, 2000000}};
    return map;
}

Run exampleRun() {
    Run run;
    run.dataset = "kitchen";
    run.sensor = "mrpt::obs::CObservation3DRangeScan";
    run.scansMapped = 225;
    run.scansTested = 25;
    run.split.every = 10;
    run.split.seed = 42;
    return run;
}

/// The cells of a map's row in the n-th table, tags and all.
std::vector<std::string> cells(const std::string& html, std::size_t table,
                               const std::string& name) {
    std::size_t from = 0;
    for (std::size_t i = 0; i <= table; ++i) from = html.find("<table", from + 1);
    const std::string text = html.substr(from, html.find("</table>", from) - from);
    const std::size_t row = text.find("<tr><th scope=\"row\">" + name + "<");
    if (row == std::string::npos) return {};
    const std::string line = text.substr(row, text.find("</tr>", row) - row);
    std::vector<std::string> found;
    const std::regex cell("<td>(.*?)</td>");
    for (std::sregex_iterator it(line.begin(), line.end(), cell), end; it != end; ++it)
        found.push_back((*it)[1]);
    return found;
}

constexpr std::size_t kAccuracy = 0, kCost = 1;

std::vector<std::string> svgs(const std::string& html) {
    std::vector<std::string> found;
    for (std::size_t at = html.find("<svg"); at != std::string::npos;
         at = html.find("<svg", at + 1))
        found.push_back(html.substr(at, html.find("</svg>", at) - at));
    return found;
}

/// Distinct finite points of the line of a curve; the marks of a curve of one point count.
std::size_t pointsOfCurve(const std::string& svg, const std::string& label) {
    const std::size_t at = svg.find("<g><title>" + label + "</title>");
    if (at == std::string::npos) return 0;
    const std::string group = svg.substr(at, svg.find("</g>", at) - at);
    const std::size_t line = group.find("<polyline");
    if (line == std::string::npos)
        return group.find("<circle") != std::string::npos ||
               group.find("<polygon") != std::string::npos;
    std::istringstream text(group.substr(group.find("points='", line) + 8));
    std::set<std::pair<double, double>> points;
    double x = 0, y = 0;
    char comma = 0;
    while (text >> x >> comma >> y)
        if (std::isfinite(x) && std::isfinite(y)) points.emplace(x, y);
    return points.size();
}

TEST(HtmlReport, TellsWhatWasRun) {
    auto run = exampleRun();
    run.nearBand = {0.05, 0.3};
    run.threads = 2;
    std::string html = htmlReport(run, {exampleMap("ours", 0.9, 0.1)}, {});
    for (const char* part :
         {"<!DOCTYPE html>", "<html lang=\"en\">", "name=\"viewport\"", "<h1>kitchen</h1>",
          "<title>kitchen", "rel=\"icon\" href=\"data:,\"", "CObservation3DRangeScan",
          "225 mapped, 25 tested", "one scan of 10", "<dd>42</dd>", "0.05 to 0.3 m",
          "2 for the first map"})
        EXPECT_NE(html.find(part), std::string::npos) << part;
    EXPECT_EQ(html.find("interrupted"), std::string::npos);
    run.interrupted = true;
    run.split.holdoutPoints = 0.2;
    html = htmlReport(run, {exampleMap("ours", 0.9, 0.1)}, {});
    EXPECT_NE(html.find("interrupted"), std::string::npos);
    EXPECT_NE(html.find("20 % of the points"), std::string::npos);
}

TEST(HtmlReport, TheBestOfRankedMapsIsInBold) {
    std::vector<MapFigures> maps = {
        exampleMap("ours", 0.95, 0.10), exampleMap("tied", 0.95001, 0.2),
        exampleMap("worse", 0.8, 0.05), exampleMap("nearest", 0.99, 0.01)};
    maps[3].ranked = false;
    maps[3].meaning = Meaning::nearness;
    maps[2].memory.live_bytes = 1000;
    maps[3].memory.live_bytes = 10;
    const std::string html = htmlReport(exampleRun(), maps, {});
    const auto ours = cells(html, kAccuracy, "ours"), tied = cells(html, kAccuracy, "tied"),
               worse = cells(html, kAccuracy, "worse"),
               nearest = cells(html, kAccuracy, "nearest");
    ASSERT_EQ(ours.size(), 9U);
    // Equal as printed, so both are best; the unranked one leads but does not compete.
    EXPECT_EQ(ours[1], "<b>0.9500</b>");
    EXPECT_EQ(tied[1], "<b>0.9500</b>");
    EXPECT_EQ(worse[1], "0.8000");
    EXPECT_EQ(nearest[1], "0.9900");
    // Lower is better.
    EXPECT_EQ(ours[4], "0.1000");
    EXPECT_EQ(worse[4], "<b>0.0500</b>");
    EXPECT_EQ(nearest[4], "\u2013") << "its answers are no probabilities";
    EXPECT_EQ(ours[6], "0.000") << "not knowing is neither good nor bad";
    EXPECT_EQ(cells(html, kCost, "worse")[1], "<b>1.0</b>");
    EXPECT_EQ(cells(html, kCost, "ours")[1], "2000.0");
    EXPECT_EQ(cells(html, kCost, "nearest")[1], "0.0");
    EXPECT_NE(html.find("not a probability of occupancy"), std::string::npos);
    EXPECT_GT(html.find(">nearest<"), html.find("<tbody class=\"unranked\">"));
    EXPECT_LT(html.find(">worse<"), html.find("<tbody class=\"unranked\">"));
}

TEST(HtmlReport, TheTruePositiveRateIsThatAtFivePercent) {
    // Half way from (0, 0) to (0.1, auc).
    const std::string html = htmlReport(
        exampleRun(), {exampleMap("a", 0.8, 0.1), exampleMap("b", 0.4, 0.1)}, {});
    EXPECT_EQ(cells(html, kAccuracy, "a")[2], "<b>0.4000</b>");
    EXPECT_EQ(cells(html, kAccuracy, "b")[2], "0.2000");
}

TEST(HtmlReport, WhatIsNotKnownIsADashAndNeverBest) {
    std::vector<MapFigures> maps = {exampleMap("a", std::nan(""), INFINITY),
                                    exampleMap("b", 0.7, 0.3), exampleMap("c", 0.6, 0.2)};
    maps[0].occupancy->rocNear.clear();
    maps[1].memory.serialized_bytes = 5000;
    maps[2].insert_ms.clear();
    maps[0].occupancy->rocUniform.clear();
    maps[0].occupancy->reliability.clear();
    maps[0].memory.live_bytes = 0;
    const std::string html = htmlReport(exampleRun(), maps, {});
    for (const std::size_t column : {0, 1, 2, 3, 4, 5})
        EXPECT_EQ(cells(html, kAccuracy, "a")[column], "\u2013") << column;
    EXPECT_EQ(cells(html, kAccuracy, "b")[1], "<b>0.7000</b>");
    EXPECT_EQ(cells(html, kCost, "b")[0], "5.0") << "nothing to compare it with";
    EXPECT_EQ(cells(html, kCost, "c")[0], "\u2013");
    EXPECT_EQ(cells(html, kCost, "c")[2], "\u2013");
    EXPECT_EQ(html.find("nan"), std::string::npos);
    EXPECT_EQ(html.find("inf"), std::string::npos);
}

TEST(HtmlReport, EveryPlotShowsEveryMap) {
    std::vector<MapFigures> maps = {exampleMap("ours", 0.9, 0.1),
                                    exampleMap("peer", 0.8, 0.2)};
    maps[0].levels = {{0, 100, 50, 4000, 0.0, 0.9, 0.9}, {1, 50, 20, 2000, 0.1, 0.85, 0.8}};
    const std::vector<std::string> plots = svgs(htmlReport(exampleRun(), maps, {}));
    ASSERT_EQ(plots.size(), 6U);
    for (std::size_t i = 0; i < plots.size(); ++i) {
        EXPECT_GE(pointsOfCurve(plots[i], "ours"), 2U) << plots[i];
        // A map without levels is one point in the plot of levels.
        EXPECT_GE(pointsOfCurve(plots[i], "peer"), i == 3 ? 1U : 2U) << plots[i];
    }
}

TEST(HtmlReport, ShowsWhatThereIsWithoutTestPoints) {
    MapFigures map = exampleMap("ours", 0.9, 0.1);
    map.occupancy.reset();
    const std::string html = htmlReport(exampleRun(), {map}, {});
    EXPECT_EQ(svgs(html).size(), 2U) << "time and memory";
    EXPECT_NE(html.find("no test points"), std::string::npos);
    EXPECT_EQ(cells(html, 0, "ours").size(), 8U) << "the table of cost alone";
    EXPECT_NO_THROW(htmlReport({}, {}, {}));
}

TEST(HtmlReport, TellsWhereEachMapComesFrom) {
    MapFigures map = exampleMap("ours", 0.9, 0.1);
    map.levels = {{0, 100, 50, 4000, 0.0, 0.9, 0.9}};
    map.logLikelihoodOfHits = 1.2345;
    const std::string html =
        htmlReport(exampleRun(), {map, exampleMap("peer", 0.8, 0.2)}, {});
    for (const char* part :
         {"class::of::ours", "Paper about ours", "class::of::peer", "Paper about peer",
          "resolution_m = 0.05", "100 components of surfaces, 50 of free", "1.234"})
        EXPECT_NE(html.find(part), std::string::npos) << part;
}

TEST(HtmlReport, NamesAreTextNotMarkup) {
    auto run = exampleRun();
    run.dataset = "<b>&\"x\"";
    run.sensor = "<script>";
    MapFigures map = exampleMap("<i>'m", 0.9, 0.1);
    map.source = "A & B <2001>";
    const std::string html = htmlReport(run, {map}, {{"<u>", "1 < 2", {1, 1, {1, 2, 3}}}});
    for (const char* part : {"<b>&", "<script", "<i>", "A & B", "<u>", "1 < 2"})
        EXPECT_EQ(html.find(part), std::string::npos) << part;
    EXPECT_NE(html.find("<h1>&lt;b&gt;&amp;&quot;x&quot;</h1>"), std::string::npos);
}

TEST(HtmlReport, NeedsNoNetworkAndNoScripts) {
    MapFigures map = exampleMap("ours", 0.9, 0.1);
    map.source = "Library, https://example.org";  // a text, not a link
    const std::string html = htmlReport(exampleRun(), {map}, {{"", "", {1, 1, {1, 2, 3}}}});
    const std::regex load("(src|href)\\s*=\\s*[\"']?([^\"'>]*)");
    int loads = 0;
    for (std::sregex_iterator it(html.begin(), html.end(), load), end; it != end; ++it) {
        EXPECT_EQ((*it)[2].str().rfind("data:", 0), 0U) << (*it)[0].str();
        ++loads;
    }
    EXPECT_EQ(loads, 2) << "the icon and the picture";
    for (const char* part : {"<script", "url(", "@import", "<iframe", "<object", "http://"})
        EXPECT_EQ(html.find(part), std::string::npos) << part;
}

TEST(HtmlReport, PicturesAreInThePage) {
    const Picture picture{
        3, 2, {1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15, 16, 17, 18}};
    const std::string html =
        htmlReport(exampleRun(), {exampleMap("ours", 0.9, 0.1)},
                   {{"Input", "all points", picture}, {"Map", "ellipsoids", picture}});
    const std::string image = "width=\"3\" height=\"2\" src=\"data:image/png;base64," +
                              base64(pngOf(picture)) + "\"";
    const std::size_t first = html.find(image);
    ASSERT_NE(first, std::string::npos);
    EXPECT_NE(html.find(image, first + 1), std::string::npos);
    for (const char* part : {"<h3>Input</h3>", "all points", "<h3>Map</h3>", "ellipsoids"})
        EXPECT_NE(html.find(part), std::string::npos) << part;
    EXPECT_THROW(htmlReport(exampleRun(), {}, {{"", "", {}}}), std::invalid_argument);
}

TEST(HtmlReport, TheSameFiguresGiveTheSamePage) {
    const std::vector<MapFigures> maps = {exampleMap("ours", 0.9, 0.1)};
    EXPECT_EQ(htmlReport(exampleRun(), maps, {}), htmlReport(exampleRun(), maps, {}));
}

}  // namespace
}  // namespace hgmm::evaluation
