#include "hgmm/evaluation/occupancy_plots.h"

#include <algorithm>
#include <cmath>

#include "report/curve_of_map.h"

namespace hgmm::evaluation {
namespace {

void addRoc(const RocCurve& roc, Curve& curve) {
    constexpr double step = 0.002;  // less than two pixels
    for (const RocPoint& p : thinned(roc, step)) curve.points.emplace_back(p.fpr, p.tpr);
}

Curve labelledRoc(const RocCurve& roc, const std::string& label, bool emphasised) {
    Curve curve;
    curve.label = label;
    curve.emphasised = emphasised;
    addRoc(roc, curve);
    return curve;
}

/// From (0, 0) to (1, 1), as a backdrop.
Curve diagonal() {
    Curve curve;
    curve.points = {{0.0, 0.0}, {1.0, 1.0}};
    return curve;
}

Plot rocAxes(const std::string& title) {
    Plot plot;
    plot.title = title;
    plot.xLabel = "false positive rate";
    plot.yLabel = "true positive rate";
    plot.curves.push_back(diagonal());
    return plot;
}

}  // namespace

Plot rocPlot(const std::vector<MapFigures>& maps) {
    Plot plot =
        rocAxes("Occupied or free: thick, free points near the hit; thin, anywhere");
    for (const MapFigures& map : maps) {
        if (!map.occupancy) continue;
        plot.curves.push_back(
            labelledRoc(map.occupancy->rocNear, map.name + ", near", true));
        plot.curves.push_back(
            labelledRoc(map.occupancy->rocUniform, map.name + ", uniform", false));
    }
    return plot;
}

Plot rocNearPlot(const std::vector<MapFigures>& maps) {
    Plot plot = rocAxes("Hits or free points near them");
    for (const MapFigures& map : maps) {
        if (!map.occupancy) continue;
        plot.curves.push_back(curveOfMap(map, maps));
        addRoc(map.occupancy->rocNear, plot.curves.back());
    }
    return plot;
}

Plot rocUniformPlot(const std::vector<MapFigures>& maps) {
    constexpr double decades = 4.0, step = 0.04;
    Plot plot = rocAxes("Hits or free points anywhere");
    plot.xLogarithmic = true;
    plot.curves.front().points.clear();
    for (double x = -decades; x < 0.5 * step; x += step) {
        const double fpr = std::min(1.0, std::pow(10.0, x));
        plot.curves.front().points.emplace_back(fpr, fpr);
    }
    for (const MapFigures& map : maps) {
        if (!map.occupancy || map.occupancy->rocUniform.empty()) continue;
        Curve curve = curveOfMap(map, maps);
        curve.points = plot.curves.front().points;
        for (auto& [fpr, tpr] : curve.points) tpr = tprAt(map.occupancy->rocUniform, fpr);
        plot.curves.push_back(curve);
    }
    return plot;
}

Plot reliabilityPlot(const std::vector<MapFigures>& maps) {
    Plot plot;
    plot.title = "Reliability: hits and near free points 1:1, in bins of equal mass";
    plot.xLabel = "P(occupied) of the map, mean of the bin";
    plot.yLabel = "occupied share of the bin";
    plot.curves.push_back(diagonal());
    for (const MapFigures& map : maps) {
        if (!map.occupancy || map.meaning != Meaning::occupancy) continue;
        Curve curve = curveOfMap(map, maps);
        curve.markers = true;
        for (const ReliabilityBin& bin : map.occupancy->reliability)
            curve.points.emplace_back(bin.meanProbability, bin.occupiedShare);
        plot.curves.push_back(curve);
    }
    return plot;
}

Plot levelsPlot(const std::vector<MapFigures>& maps) {
    Plot plot;
    plot.title = "Accuracy against memory (levels of the hierarchy joined)";
    plot.xLabel = "memory [KB]";
    plot.yLabel = "AUC, near free points";
    plot.xLogarithmic = true;
    constexpr double kilobyte = 1000.0;
    for (const MapFigures& map : maps) {
        Curve curve = curveOfMap(map, maps);
        curve.markers = true;
        for (const LevelFigures& level : map.levels)
            if (level.aucNear && level.bytes > 0)
                curve.points.emplace_back(static_cast<double>(level.bytes) / kilobyte,
                                          *level.aucNear);
        const double own = static_cast<double>(countedBytes(map.memory)) / kilobyte;
        if (map.levels.empty() && map.occupancy && own > 0)
            curve.points.emplace_back(own, map.occupancy->aucNear);
        if (!curve.points.empty()) plot.curves.push_back(curve);
    }
    return plot;
}

}  // namespace hgmm::evaluation
