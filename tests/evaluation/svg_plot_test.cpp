#include "hgmm/evaluation/svg_plot.h"

#include <gtest/gtest.h>

#include <set>
#include <sstream>

#include "hgmm/evaluation/cost_plots.h"

namespace hgmm::evaluation {
namespace {

using Points2 = std::vector<std::pair<double, double>>;

/// The values of an attribute, in order, of all elements of a name.
std::vector<std::string> attributes(const std::string& svg, const std::string& element,
                                    const std::string& name) {
    std::vector<std::string> values;
    for (std::size_t at = svg.find("<" + element); at != std::string::npos;
         at = svg.find("<" + element, at + 1)) {
        const std::string tag = svg.substr(at, svg.find('>', at) - at);
        const std::size_t from = tag.find(" " + name + "='");
        if (from == std::string::npos) {
            values.emplace_back();
            continue;
        }
        const std::size_t begin = from + name.size() + 3;
        values.push_back(tag.substr(begin, tag.find('\'', begin) - begin));
    }
    return values;
}

/// The corners of the n-th polyline.
Points2 polyline(const std::string& svg, std::size_t n) {
    std::istringstream text(attributes(svg, "polyline", "points").at(n));
    Points2 points;
    double x = 0, y = 0;
    char comma = 0;
    while (text >> x >> comma >> y) points.emplace_back(x, y);
    return points;
}

Plot manyCurves(int n) {
    Plot plot{"a title", "x [m]", "y [m]", {}};
    for (int i = 0; i < n; ++i) {
        Curve& curve = plot.curves.emplace_back();
        curve.label = "curve " + std::to_string(i);
        for (int k = 0; k < 20; ++k) curve.points.emplace_back(k, i + k);
    }
    return plot;
}

TEST(SvgPlotStyle, CurvesDifferByMoreThanColour) {
    const std::string svg = toSvg(manyCurves(8));
    const auto colours = attributes(svg, "polyline", "stroke");
    const auto dashes = attributes(svg, "polyline", "stroke-dasharray");
    ASSERT_EQ(colours.size(), 16U) << "each as a line and in the legend";
    std::set<std::pair<std::string, std::string>> styles;
    for (std::size_t i = 0; i < 8; ++i) {
        styles.emplace(colours[i], dashes[i]);
        EXPECT_EQ(colours[i], colours[8 + i]) << "the legend shows the line";
        EXPECT_EQ(dashes[i], dashes[8 + i]);
    }
    EXPECT_EQ(styles.size(), 8U);
    EXPECT_EQ(std::set<std::string>(dashes.begin(), dashes.begin() + 5).size(), 5U);
}

TEST(SvgPlotStyle, TheLegendLiesBelowTheAxesWithinThePicture) {
    for (const int n : {1, 2, 9, 30}) {
        const std::string svg = toSvg(manyCurves(n));
        double width = 0, height = 0;
        ASSERT_EQ(std::sscanf(svg.c_str() + svg.find("viewBox="), "viewBox='0 0 %lf %lf",
                              &width, &height),
                  2);
        const double frame = std::stod(attributes(svg, "rect", "y").at(1)) +
                             std::stod(attributes(svg, "rect", "height").at(1));
        for (std::size_t i = 0; i < std::size_t(n); ++i)
            for (const auto& [x, y] : polyline(svg, std::size_t(n) + i)) {
                EXPECT_GT(y, frame + 45) << "below the label of the axis";
                EXPECT_LT(y, height);
                EXPECT_GT(x, 0);
                EXPECT_LT(x, width);
            }
    }
}

TEST(SvgPlotStyle, DecadesAreEquallyHighOnALogarithmicAxis) {
    Plot plot{"", "x", "y [KB]", {{{{0, 10}, {1, 100}, {2, 10000}}, "map"}}};
    plot.yLogarithmic = true;
    const std::string svg = toSvg(plot);
    const Points2 line = polyline(svg, 0);
    ASSERT_EQ(line.size(), 3U);
    EXPECT_LT(line[1].second, line[0].second);
    EXPECT_NEAR(line[1].second - line[2].second, 2 * (line[0].second - line[1].second),
                0.01);
    EXPECT_NEAR(line[2].first - line[1].first, line[1].first - line[0].first, 0.01);
    EXPECT_NE(svg.find(">1000</text>"), std::string::npos);
    plot.curves[0].points[1].second = 0.0;
    EXPECT_THROW(toSvg(plot), std::invalid_argument);
    plot.curves[0].points = {{1, 5}};
    EXPECT_NE(toSvg(plot).find(">5</text>"), std::string::npos) << "a tick near one point";
}

TEST(SvgPlotStyle, LongNumbersAreShortened) {
    Plot plot;
    plot.xLogarithmic = true;
    plot.curves.push_back({{{1e3, 0.0}, {2e6, 1.0}}, "map"});
    const std::string svg = toSvg(plot);
    for (const char* label : {">10000<", ">100k<", ">1M<"})
        EXPECT_NE(svg.find(label), std::string::npos) << label;
    EXPECT_EQ(svg.find("e+0"), std::string::npos);
}

TEST(SvgPlotStyle, WithinHtmlThereAreNoNameSpacesAndNoIds) {
    const Plot plot = manyCurves(2);
    EXPECT_NE(toSvg(plot).find(" xmlns='http://www.w3.org/2000/svg'"), std::string::npos);
    const std::string svg = toInlineSvg(plot);
    EXPECT_EQ(svg.find("http"), std::string::npos);
    EXPECT_EQ(svg.find(" id="), std::string::npos);
    EXPECT_NE(svg.find("aria-label='a title'"), std::string::npos);
}

TEST(SvgPlotStyle, LabelsAreText) {
    Plot plot = manyCurves(1);
    plot.curves[0].label = "<b>&'\"";
    plot.title = "' onload='x";
    const std::string svg = toInlineSvg(plot);
    EXPECT_EQ(svg.find("<b>"), std::string::npos);
    EXPECT_NE(svg.find("&lt;b&gt;&amp;&#39;&quot;"), std::string::npos);
    EXPECT_EQ(svg.find("' onload"), std::string::npos);
}

MapFigures mapWithTimes(const std::string& name, std::size_t scans, double ms) {
    MapFigures map;
    map.name = name;
    for (std::size_t i = 0; i < scans; ++i) map.insert_ms.push_back(ms + double(i % 3));
    return map;
}

TEST(CostPlots, ShowEachScanOfAShortRun) {
    const Plot plot = insertionPlot({mapWithTimes("a", 4, 10), mapWithTimes("b", 0, 1)});
    ASSERT_EQ(plot.curves.size(), 1U) << "a map without times is left out";
    EXPECT_EQ(plot.curves[0].points, (Points2{{1, 10}, {2, 11}, {3, 12}, {4, 10}}));
    EXPECT_EQ(plot.yLabel, "insertion [ms]");
    EXPECT_FALSE(plot.yLogarithmic);
}

TEST(CostPlots, ShowMediansOfALongRun) {
    // 700 scans in groups of 3, each 10, 11, 12 ms; the last is scan 700 alone.
    const Plot plot = insertionPlot({mapWithTimes("a", 700, 10)});
    const Points2& points = plot.curves.at(0).points;
    ASSERT_EQ(points.size(), 234U);
    EXPECT_EQ(points[0], std::make_pair(2.0, 11.0));
    EXPECT_EQ(points[1], std::make_pair(5.0, 11.0));
    EXPECT_EQ(points.back(), std::make_pair(700.0, 10.0));
    EXPECT_NE(plot.yLabel.find("median of 3"), std::string::npos);
}

TEST(CostPlots, AxesAreLogarithmicWhereMapsAreFarApart) {
    EXPECT_TRUE(
        insertionPlot({mapWithTimes("a", 5, 1), mapWithTimes("b", 5, 500)}).yLogarithmic);
    MapFigures map = mapWithTimes("a", 0, 0);
    map.liveBytesOverRun = {{1, 0}, {2, 2000}, {3, 4000}};
    const Plot memory = memoryPlot({map});
    EXPECT_EQ(memory.curves.at(0).points, (Points2{{2, 2}, {3, 4}}));
    EXPECT_FALSE(memory.yLogarithmic);
    map.liveBytesOverRun.emplace_back(4, 90000000);
    EXPECT_TRUE(memoryPlot({map}).yLogarithmic);
    EXPECT_TRUE(memoryPlot({}).curves.empty());
}

TEST(CostPlots, TimesThatCannotBeDrawnAreLeftOut) {
    MapFigures map = mapWithTimes("a", 3, 10);
    map.insert_ms[1] = 0.0;
    map.insert_ms[2] = std::nan("");
    EXPECT_EQ(insertionPlot({map}).curves.at(0).points, (Points2{{1, 10}}));
}

}  // namespace
}  // namespace hgmm::evaluation
