#pragma once
#include <cstddef>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace hgmm::evaluation {

/// One line of a plot.
struct Curve {
    std::vector<std::pair<double, double>> points;  ///< (x, y) in drawing order
    std::string label;                              ///< in the legend; empty = not listed
    bool emphasised = false;                        ///< drawn on top and thick
    bool markers = false;                           ///< a filled mark at each point
    /// Number of its colour, dashes and mark, for curves that look the same in several
    /// plots; its place among labelled curves if there is none.
    std::optional<std::size_t> style = std::nullopt;
};

/// A line plot with labelled axes and its legend below. Labelled curves differ in colour
/// (all of which colour-blind people can tell apart), dashes and marks; the others are a
/// grey backdrop.
struct Plot {
    std::string title;
    std::string xLabel;  ///< with its unit
    std::string yLabel;  ///< with its unit
    std::vector<Curve> curves;
    bool xLogarithmic = false;
    bool yLogarithmic = false;
};

/// A document of its own. Throws std::invalid_argument if no curve holds a point, or a
/// coordinate is not finite, or not positive on a logarithmic axis.
std::string toSvg(const Plot& plot);

/// The same as an element to stand within HTML: without name spaces or ids, so that any
/// number of them fit in one page.
std::string toInlineSvg(const Plot& plot);

}  // namespace hgmm::evaluation
