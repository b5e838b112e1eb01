#include "hgmm/evaluation/cost_plots.h"

#include <algorithm>
#include <cmath>

#include "report/curve_of_map.h"

namespace hgmm::evaluation {
namespace {

/// A logarithmic axis shows maps of very different cost in one plot, but cannot start at
/// zero: it is for those only.
bool spansDecades(const std::vector<Curve>& curves) {
    constexpr double wide = 30.0;
    double low = INFINITY, high = 0.0;
    for (const Curve& curve : curves)
        for (const auto& [x, y] : curve.points) {
            low = std::min(low, y);
            high = std::max(high, y);
        }
    return high > wide * low;
}

/// What a logarithmic axis could not show is left out.
void addPoint(Curve& curve, double x, double y) {
    if (std::isfinite(y) && y > 0.0) curve.points.emplace_back(x, y);
}

}  // namespace

Plot insertionPlot(const std::vector<MapFigures>& maps) {
    constexpr std::size_t most = 300;  // points of a curve
    std::size_t scans = 0;
    for (const MapFigures& map : maps) scans = std::max(scans, map.insert_ms.size());
    const std::size_t group = std::max<std::size_t>(1, (scans + most - 1) / most);

    Plot plot;
    plot.title = "Time to insert a scan";
    plot.xLabel = "mapping scan [number]";
    plot.yLabel = group == 1 ? "insertion [ms]"
                             : "insertion, median of " + std::to_string(group) + " [ms]";
    for (const MapFigures& map : maps) {
        Curve curve = curveOfMap(map, maps);
        for (std::size_t i = 0; i < map.insert_ms.size(); i += group) {
            const std::size_t end = std::min(i + group, map.insert_ms.size());
            const auto first = map.insert_ms.begin();
            addPoint(curve,
                     static_cast<double>(i + 1) + 0.5 * static_cast<double>(end - i - 1),
                     median({first + static_cast<std::ptrdiff_t>(i),
                             first + static_cast<std::ptrdiff_t>(end)}));
        }
        if (!curve.points.empty()) plot.curves.push_back(curve);
    }
    plot.yLogarithmic = spansDecades(plot.curves);
    return plot;
}

Plot memoryPlot(const std::vector<MapFigures>& maps) {
    Plot plot;
    plot.title = "Live memory over the run";
    plot.xLabel = "mapping scans inserted [number]";
    plot.yLabel = "live memory [KB]";
    for (const MapFigures& map : maps) {
        Curve curve = curveOfMap(map, maps);
        for (const auto& [scans, bytes] : map.liveBytesOverRun)
            addPoint(curve, static_cast<double>(scans),
                     static_cast<double>(bytes) / 1000.0);
        if (!curve.points.empty()) plot.curves.push_back(curve);
    }
    plot.yLogarithmic = spansDecades(plot.curves);
    return plot;
}

}  // namespace hgmm::evaluation
