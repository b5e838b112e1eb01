#include "report/svg_axes.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <sstream>
#include <stdexcept>

#include "report/markup.h"

namespace hgmm::evaluation {
namespace {

/// The decades, and between few of them 2 and 5 as well.
std::vector<double> logarithmicTicks(double low, double high) {
    std::vector<double> values;
    const bool few = high - low < 2.5;
    for (double decade = std::floor(low); decade <= high; ++decade)
        for (const double factor : {1.0, 2.0, 5.0}) {
            const double v = factor * std::pow(10.0, decade);
            if (factor > 1.0 && !few) continue;
            if (std::log10(v) >= low && std::log10(v) <= high) values.push_back(v);
        }
    return values;
}

/// Words joined to lines no longer than the plot is wide.
std::vector<std::string> lines(const std::string& title) {
    constexpr std::size_t longest = 56;
    std::vector<std::string> result(1);
    std::istringstream words(title);
    for (std::string word; words >> word;) {
        if (!result.back().empty() && result.back().size() + 1 + word.size() > longest)
            result.emplace_back();
        result.back() += (result.back().empty() ? "" : " ") + word;
    }
    return result;
}

/// "100k" for 100000: long numbers fit neither beside nor below an axis.
std::string tickLabel(double v) {
    if (std::abs(v) >= 1e6) return number(v / 1e6) + "M";
    if (std::abs(v) >= 1e5) return number(v / 1e3) + "k";
    return number(v);
}

std::string drawTitle(const std::string& title) {
    constexpr double lineHeight = 17;
    const std::vector<std::string> rows = lines(title);
    double y = layout::top - 10 - lineHeight * static_cast<double>(rows.size() - 1);
    std::string svg;
    for (const std::string& row : rows) {
        svg += textAt(0.5 * layout::width, y, "middle", row, "font-weight='bold'");
        y += lineHeight;
    }
    return svg;
}

}  // namespace

std::string number(double v) {
    return formatted("%.6g", v);
}

std::string textAt(double x, double y, const char* anchor, const std::string& text,
                   const std::string& attributes) {
    return "<text x='" + number(x) + "' y='" + number(y) + "' text-anchor='" + anchor +
           "' " + attributes + ">" + escaped(text) + "</text>\n";
}

double Axis::toPixel(double v) const {
    const double at = logarithmic ? std::log10(v) : v;
    return pixelLow + (at - low) / (high - low) * (pixelHigh - pixelLow);
}

std::vector<double> Axis::ticks() const {
    if (logarithmic) return logarithmicTicks(low, high);
    const double raw = (high - low) / 10.0;
    const double decade = std::pow(10.0, std::floor(std::log10(raw)));
    double step = 10.0 * decade;
    for (const double factor : {5.0, 2.0, 1.0})
        if (factor * decade >= raw) step = factor * decade;
    std::vector<double> values;
    for (double k = std::ceil(low / step); k * step <= high + 1e-9 * step; ++k)
        values.push_back(k * step + 0.0);  // no -0
    return values;
}

Axis fitAxis(const Plot& plot, bool vertical) {
    const bool logarithmic = vertical ? plot.yLogarithmic : plot.xLogarithmic;
    double low = std::numeric_limits<double>::infinity(), high = -low;
    for (const Curve& curve : plot.curves) {
        for (const auto& [x, y] : curve.points) {
            const double data = vertical ? y : x;
            const double v = logarithmic ? std::log10(data) : data;
            if (!std::isfinite(v))
                throw std::invalid_argument("toSvg: not finite: " + curve.label);
            low = std::min(low, v);
            high = std::max(high, v);
        }
    }
    if (low > high) throw std::invalid_argument("toSvg: there is nothing to plot");
    const double alone = logarithmic ? 0.5 : std::max(1.0, 0.1 * std::abs(low));
    const double margin = high > low ? 0.03 * (high - low) : alone;
    low -= margin;
    high += margin;
    if (vertical) return {low, high, layout::bottom, layout::top, logarithmic};
    return {low, high, layout::left, layout::right, logarithmic};
}

std::string drawAxes(const Plot& plot, const Axis& x, const Axis& y) {
    using namespace layout;
    std::string svg;
    for (const double v : x.ticks()) {
        const std::string at = number(x.toPixel(v));
        svg += "<line x1='" + at + "' x2='" + at + "' y1='" + number(top) + "' y2='" +
               number(bottom) + "' stroke='#dddddd'/>\n";
        svg += textAt(x.toPixel(v), bottom + 18, "middle", tickLabel(v));
    }
    for (const double v : y.ticks()) {
        const std::string at = number(y.toPixel(v));
        svg += "<line y1='" + at + "' y2='" + at + "' x1='" + number(left) + "' x2='" +
               number(right) + "' stroke='#dddddd'/>\n";
        svg += textAt(left - 6, y.toPixel(v) + 5, "end", tickLabel(v));
    }
    svg += "<rect x='" + number(left) + "' y='" + number(top) + "' width='" +
           number(right - left) + "' height='" + number(bottom - top) +
           "' fill='none' stroke='#444444'/>\n";
    svg += textAt(0.5 * (left + right), bottom + 40, "middle", plot.xLabel);
    svg += textAt(
        0, 0, "middle", plot.yLabel,
        "transform='translate(17 " + number(0.5 * (top + bottom)) + ") rotate(-90)'");
    return svg + drawTitle(plot.title);
}

}  // namespace hgmm::evaluation
