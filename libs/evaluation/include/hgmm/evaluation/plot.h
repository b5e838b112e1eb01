#pragma once
#include <nlohmann/json.hpp>
#include <string>
#include <utility>
#include <vector>

namespace hgmm::evaluation {

/// One line of a plot.
struct Curve {
    std::vector<std::pair<double, double>> points;  ///< (x, y) in drawing order
    std::string label;                              ///< in the legend; empty: a backdrop
    bool emphasised = false;                        ///< drawn on top and thick
};

/// A line plot of a study, as metrics.json holds it in `plots`; hgmm.report draws it.
struct Plot {
    std::string title;
    std::string xLabel;  ///< with its unit
    std::string yLabel;  ///< with its unit
    std::vector<Curve> curves;
};

/// An entry of `plots`. Throws std::invalid_argument if no curve holds a point, or a
/// coordinate is not finite.
nlohmann::ordered_json plotJson(const Plot& plot);

}  // namespace hgmm::evaluation
