#include "hgmm/evaluation/svg_plot.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
#include <stdexcept>

namespace hgmm::evaluation {
namespace {

constexpr double kWidth = 720, kHeight = 440;
constexpr double kLeft = 80, kRight = 20, kTop = 40, kBottom = 60;  // margins
constexpr const char* kColours[] = {"#0b5fa5", "#c4421a", "#2e7d32", "#6a3d9a",
                                    "#8d6e00", "#00838f", "#ad1457", "#455a64"};

std::string number(double v) {
    char text[32];
    std::snprintf(text, sizeof text, "%.6g", v);
    return text;
}

std::string escaped(const std::string& text) {
    std::string out;
    for (const char c : text) {
        if (c == '&')
            out += "&amp;";
        else if (c == '<')
            out += "&lt;";
        else
            out += c;
    }
    return out;
}

std::string textAt(double x, double y, const char* anchor, const std::string& text,
                   const std::string& more = "") {
    return "<text x='" + number(x) + "' y='" + number(y) + "' text-anchor='" + anchor +
           "' " + more + ">" + escaped(text) + "</text>\n";
}

/// One axis: its data range and where that lies on the page. Logarithmic ones have the
/// decimal logarithm of the data as their range.
struct Axis {
    double low, high;            // data
    double pixelLow, pixelHigh;  // page
    bool logarithmic;

    double toPixel(double v) const {
        const double at = logarithmic ? std::log10(v) : v;
        return pixelLow + (at - low) / (high - low) * (pixelHigh - pixelLow);
    }

    /// The decades, and between few of them 2 and 5 as well.
    std::vector<double> logarithmicTicks() const {
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

    /// Four to ten round values.
    std::vector<double> ticks() const {
        if (logarithmic) return logarithmicTicks();
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
};

Axis fitAxis(const Plot& plot, bool vertical) {
    const bool logarithmic = plot.xLogarithmic && !vertical;
    double low = std::numeric_limits<double>::infinity(), high = -low;
    for (const Curve& curve : plot.curves) {
        for (const auto& [x, y] : curve.points) {
            const double v = vertical ? y : logarithmic ? std::log10(x) : x;
            if (!std::isfinite(v))
                throw std::invalid_argument("toSvg: not finite: " + curve.label);
            low = std::min(low, v);
            high = std::max(high, v);
        }
    }
    if (low > high) throw std::invalid_argument("toSvg: there is nothing to plot");
    const double margin =
        high > low ? 0.03 * (high - low) : std::max(1.0, 0.1 * std::abs(low));
    low -= margin;
    high += margin;
    if (vertical) return {low, high, kHeight - kBottom, kTop, false};
    return {low, high, kLeft, kWidth - kRight, logarithmic};
}

std::string drawAxes(const Plot& plot, const Axis& x, const Axis& y) {
    std::string svg;
    const double bottom = kHeight - kBottom, right = kWidth - kRight;
    for (const double v : x.ticks()) {
        const std::string at = number(x.toPixel(v));
        svg += "<line x1='" + at + "' x2='" + at + "' y1='" + number(kTop) + "' y2='" +
               number(bottom) + "' stroke='#dddddd'/>\n";
        svg += textAt(x.toPixel(v), bottom + 18, "middle", number(v));
    }
    for (const double v : y.ticks()) {
        const std::string at = number(y.toPixel(v));
        svg += "<line y1='" + at + "' y2='" + at + "' x1='" + number(kLeft) + "' x2='" +
               number(right) + "' stroke='#dddddd'/>\n";
        svg += textAt(kLeft - 8, y.toPixel(v) + 4, "end", number(v));
    }
    svg += "<rect x='" + number(kLeft) + "' y='" + number(kTop) + "' width='" +
           number(right - kLeft) + "' height='" + number(bottom - kTop) +
           "' fill='none' stroke='#444444'/>\n";
    svg += textAt(0.5 * (kLeft + right), kHeight - 16, "middle", plot.xLabel);
    svg += textAt(
        0, 0, "middle", plot.yLabel,
        "transform='translate(20 " + number(0.5 * (kTop + bottom)) + ") rotate(-90)'");
    return svg +
           textAt(0.5 * (kLeft + right), 24, "middle", plot.title, "font-weight='bold'");
}

std::string drawCurve(const Curve& curve, const Axis& x, const Axis& y,
                      const std::string& colour) {
    std::string svg = "<polyline fill='none' stroke='" + colour + "' stroke-width='" +
                      (curve.emphasised ? "3" : "1") + "' stroke-opacity='" +
                      (curve.emphasised ? "1" : "0.6") + "' points='";
    for (const auto& [px, py] : curve.points)
        svg += number(x.toPixel(px)) + "," + number(y.toPixel(py)) + " ";
    svg += "'/>\n";
    if (!curve.markers) return svg;
    for (const auto& [px, py] : curve.points)
        svg += "<circle r='4' fill='" + colour + "' cx='" + number(x.toPixel(px)) +
               "' cy='" + number(y.toPixel(py)) + "'/>\n";
    return svg;
}

/// The label of a curve, in the line `place` of the legend.
std::string drawLabel(const Plot& plot, const Curve& curve, std::size_t place,
                      const std::string& colour) {
    constexpr double lineHeight = 18, inset = 10;
    const auto labelled = std::count_if(plot.curves.begin(), plot.curves.end(),
                                        [](const Curve& c) { return !c.label.empty(); });
    const double height = lineHeight * static_cast<double>(labelled - 1);
    const double first =
        plot.legend == Legend::topRight ? kTop + 20 : kHeight - kBottom - 12 - height;
    const bool left = plot.legend == Legend::bottomLeft;
    return textAt(left ? kLeft + inset : kWidth - kRight - inset,
                  first + lineHeight * static_cast<double>(place), left ? "start" : "end",
                  curve.label, "fill='" + colour + "'");
}

}  // namespace

std::string toSvg(const Plot& plot) {
    const Axis x = fitAxis(plot, false), y = fitAxis(plot, true);
    std::string svg =
        "<svg xmlns='http://www.w3.org/2000/svg' viewBox='0 0 " + number(kWidth) + " " +
        number(kHeight) + "' font-family='sans-serif' font-size='13'>\n" +
        "<rect width='100%' height='100%' fill='white'/>\n" + drawAxes(plot, x, y);
    // Unlabelled curves are a backdrop, in grey; labelled ones get a colour and a legend
    // each.
    for (const bool emphasised : {false, true}) {
        std::size_t labelled = 0;
        for (const Curve& curve : plot.curves) {
            const std::size_t place = labelled;
            labelled += curve.label.empty() ? 0 : 1;
            if (curve.emphasised != emphasised) continue;
            const std::string colour =
                curve.label.empty() ? "#999999" : kColours[place % std::size(kColours)];
            svg += drawCurve(curve, x, y, colour);
            if (!curve.label.empty()) svg += drawLabel(plot, curve, place, colour);
        }
    }
    return svg + "</svg>\n";
}

}  // namespace hgmm::evaluation
