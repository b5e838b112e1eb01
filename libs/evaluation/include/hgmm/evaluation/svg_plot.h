#pragma once
#include <string>
#include <utility>
#include <vector>

namespace hgmm::evaluation {

/// One line of a plot.
struct Curve {
    std::vector<std::pair<double, double>> points;  ///< (x, y) in drawing order
    std::string label;                              ///< in the legend; empty = not listed
    bool emphasised = false;                        ///< drawn on top and thick
    bool markers = false;                           ///< a dot at each point
};

enum class Legend { topRight, bottomRight, bottomLeft };

/// A line plot with labelled axes, as a self-contained SVG document.
struct Plot {
    std::string title;
    std::string xLabel;  ///< with its unit
    std::string yLabel;  ///< with its unit
    std::vector<Curve> curves;
    Legend legend = Legend::topRight;
    bool xLogarithmic = false;
};

/// Throws std::invalid_argument if no curve holds a point, or a coordinate is not finite,
/// or not positive on a logarithmic axis.
std::string toSvg(const Plot& plot);

}  // namespace hgmm::evaluation
