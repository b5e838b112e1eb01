#pragma once
#include <string>
#include <utility>
#include <vector>

#include "hgmm/evaluation/svg_plot.h"

namespace hgmm::evaluation {

/// Where the parts of a plot lie [user units of the SVG]. So narrow that the text can still
/// be read on a phone, which shows it at three quarters of its size.
namespace layout {
constexpr double width = 480;
constexpr double left = 72, right = 464, top = 44, bottom = 330;  ///< of the frame
constexpr double legend = 394, legendRow = 19;
constexpr double fontSize = 14;
}  // namespace layout

/// One axis: its data range and where that lies on the page. Logarithmic ones have the
/// decimal logarithm of the data as their range.
struct Axis {
    double low, high;            ///< data
    double pixelLow, pixelHigh;  ///< page
    bool logarithmic;

    double toPixel(double v) const;
    /// Round values: four to ten, or the decades.
    std::vector<double> ticks() const;
};

/// Throws as toSvg.
Axis fitAxis(const Plot& plot, bool vertical);

/// Grid, frame, ticks, labels and title.
std::string drawAxes(const Plot& plot, const Axis& x, const Axis& y);

/// A coordinate, short.
std::string number(double v);

std::string textAt(double x, double y, const char* anchor, const std::string& text,
                   const std::string& attributes = "");

}  // namespace hgmm::evaluation
