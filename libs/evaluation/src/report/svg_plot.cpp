#include "hgmm/evaluation/svg_plot.h"

#include <algorithm>
#include <cmath>
#include <iterator>

#include "report/markup.h"
#include "report/svg_axes.h"

namespace hgmm::evaluation {
namespace {

/// Okabe and Ito (2008), Color Universal Design, without the yellow, which is too light for
/// lines on white.
constexpr const char* kColours[] = {"#0072b2", "#d55e00", "#009e73", "#cc79a7",
                                    "#e69f00", "#56b4e9", "#000000"};
// Numbers of colours, dashes and marks have no factor in common: many curves differ.
constexpr const char* kDashes[] = {"", "7 3", "2 3", "9 3 2 3", "14 4"};
constexpr int kMarks = 6;

struct Style {
    std::string colour;
    std::string dash;
    std::size_t mark = 0;
    double width = 1.0;
};

Style styleOf(const Curve& curve, std::size_t place) {
    if (curve.label.empty()) return {"#999999", "", 0, curve.emphasised ? 3.0 : 1.0};
    return {kColours[place % std::size(kColours)], kDashes[place % std::size(kDashes)],
            place % kMarks, curve.emphasised ? 3.0 : 1.6};
}

/// The corners of a mark around (x, y), and whether it is closed.
std::string polygon(double x, double y, std::initializer_list<std::pair<int, int>> corners,
                    const std::string& attributes) {
    std::string svg = "<polygon" + attributes + " points='";
    for (const auto& [dx, dy] : corners) svg += number(x + dx) + "," + number(y + dy) + " ";
    return svg + "'/>\n";
}

/// Filled marks are data, hollow ones only tell lines apart.
std::string drawMark(const Style& style, double x, double y, bool filled) {
    const std::string attributes = " fill='" + (filled ? style.colour : "white") +
                                   "' stroke='" + style.colour + "' stroke-width='1.5'";
    switch (style.mark) {
        case 0:
            return "<circle r='4'" + attributes + " cx='" + number(x) + "' cy='" +
                   number(y) + "'/>\n";
        case 1:
            return polygon(x, y, {{-4, -4}, {4, -4}, {4, 4}, {-4, 4}}, attributes);
        case 2:
            return polygon(x, y, {{0, -5}, {5, 4}, {-5, 4}}, attributes);
        case 3:
            return polygon(x, y, {{0, -6}, {5, 0}, {0, 6}, {-5, 0}}, attributes);
        case 4:
            return polygon(x, y, {{0, 5}, {5, -4}, {-5, -4}}, attributes);
        default:
            return polygon(x, y,
                           {{-2, -5},
                            {2, -5},
                            {2, -2},
                            {5, -2},
                            {5, 2},
                            {2, 2},
                            {2, 5},
                            {-2, 5},
                            {-2, 2},
                            {-5, 2},
                            {-5, -2},
                            {-2, -2}},
                           attributes);
    }
}

std::string drawLine(const std::vector<std::pair<double, double>>& pixels,
                     const Style& style) {
    std::string svg = "<polyline fill='none' stroke='" + style.colour + "' stroke-width='" +
                      number(style.width) + "'" +
                      (style.dash.empty() ? "" : " stroke-dasharray='" + style.dash + "'") +
                      " points='";
    for (const auto& [x, y] : pixels) svg += number(x) + "," + number(y) + " ";
    return svg + "'/>\n";
}

/// Hollow marks at equal distances along a line, shifted from curve to curve so that those
/// of lines that coincide can all be seen.
std::string drawKeyMarks(const std::vector<std::pair<double, double>>& pixels,
                         const Style& style, std::size_t place) {
    constexpr int marks = 5;
    double length = 0.0;
    for (std::size_t i = 1; i < pixels.size(); ++i)
        length += std::hypot(pixels[i].first - pixels[i - 1].first,
                             pixels[i].second - pixels[i - 1].second);
    const double step = length / marks;
    double next = step * static_cast<double>(2 * (place % 8) + 1) / 16.0, walked = 0.0;
    std::string svg;
    for (std::size_t i = 1; i < pixels.size(); ++i) {
        const auto [x, y] = pixels[i - 1];
        const double dx = pixels[i].first - x, dy = pixels[i].second - y;
        const double segment = std::hypot(dx, dy);
        for (; segment > 0.0 && next <= walked + segment; next += step) {
            const double share = (next - walked) / segment;
            svg += drawMark(style, x + share * dx, y + share * dy, false);
        }
        walked += segment;
    }
    return svg;
}

std::string drawCurve(const Curve& curve, const Axis& x, const Axis& y, const Style& style,
                      std::size_t place) {
    std::vector<std::pair<double, double>> pixels;
    pixels.reserve(curve.points.size());
    for (const auto& [px, py] : curve.points)
        pixels.emplace_back(x.toPixel(px), y.toPixel(py));
    std::string svg = "<g><title>" + escaped(curve.label) + "</title>\n";
    if (curve.label.empty()) svg = "<g>\n";
    if (pixels.size() > 1) svg += drawLine(pixels, style);
    if (curve.markers)
        for (const auto& [px, py] : pixels) svg += drawMark(style, px, py, true);
    else if (!curve.label.empty())
        svg += drawKeyMarks(pixels, style, place);
    return svg + "</g>\n";
}

/// Columns of the legend: one if a label would not fit in two.
std::size_t legendColumns(const Plot& plot) {
    constexpr std::size_t longest = 24;
    const bool fits = std::all_of(plot.curves.begin(), plot.curves.end(),
                                  [](const Curve& c) { return c.label.size() <= longest; });
    return fits ? 2 : 1;
}

/// The label of a curve, in the given place of the legend, with a piece of its line.
std::string drawLabel(const Curve& curve, std::size_t place, std::size_t columns,
                      const Style& style) {
    constexpr double sample = 36, column = 236;
    const double x = 14 + column * static_cast<double>(place % columns);
    const double y =
        layout::legend + layout::legendRow * static_cast<double>(place / columns);
    return drawLine({{x, y}, {x + sample, y}}, style) +
           drawMark(style, x + 0.5 * sample, y, curve.markers) +
           textAt(x + sample + 6, y + 5, "start", curve.label);
}

std::string draw(const Plot& plot, const std::string& attributes) {
    const Axis x = fitAxis(plot, false), y = fitAxis(plot, true);
    const auto labelled = static_cast<std::size_t>(
        std::count_if(plot.curves.begin(), plot.curves.end(),
                      [](const Curve& c) { return !c.label.empty(); }));
    const std::size_t columns = legendColumns(plot);
    const std::size_t rows = (labelled + columns - 1) / columns;
    const double height = layout::legend + layout::legendRow * static_cast<double>(rows);
    std::string svg = "<svg" + attributes + " viewBox='0 0 " + number(layout::width) + " " +
                      number(height) + "' font-family='sans-serif' font-size='" +
                      number(layout::fontSize) + "'>\n" +
                      "<rect width='100%' height='100%' fill='white'/>\n" +
                      drawAxes(plot, x, y);
    std::string backdrop, thin, thick, legend;
    std::size_t next = 0;
    for (const Curve& curve : plot.curves) {
        const std::size_t place = next;
        next += curve.label.empty() ? 0 : 1;
        const Style style = styleOf(curve, curve.style.value_or(place));
        std::string& layer = curve.emphasised      ? thick
                             : curve.label.empty() ? backdrop
                                                   : thin;
        layer += drawCurve(curve, x, y, style, place);
        if (!curve.label.empty()) legend += drawLabel(curve, place, columns, style);
    }
    return svg + backdrop + thin + thick + "<g>\n" + legend + "</g>\n</svg>\n";
}

}  // namespace

std::string toSvg(const Plot& plot) {
    return draw(plot, " xmlns='http://www.w3.org/2000/svg'");
}

std::string toInlineSvg(const Plot& plot) {
    return draw(plot, " role='img' aria-label='" + escaped(plot.title) + "'");
}

}  // namespace hgmm::evaluation
