#include "report.h"

#include "format.h"
#include "hgmm/evaluation/metrics_json.h"
#include "hgmm/evaluation/occupancy_plots.h"
#include "hgmm/evaluation/render.h"
#include "hgmm/mrpt_bridge/output_file.h"

namespace replay {

using namespace hgmm::evaluation;

namespace {

void addCost(const InsertionCost& cost, MapFigures& figures) {
    figures.scanTime_ms = summariseTimes(cost.insert_ms);
    figures.insert_ms = cost.insert_ms;
    figures.liveBytesOverRun = cost.liveBytes;
}

/// What all figures of our map share.
MapFigures ours(const char* name, MapFigures figures, const Replayed& replayed) {
    figures.name = name;
    figures.className = replayed.map->GetRuntimeClass()->className;
    addCost(replayed.cost, figures);
    return figures;
}

}  // namespace

std::vector<MapFigures> evaluateBaselines(const Replayed& replayed) {
    std::vector<MapFigures> maps;
    for (const ReplayedBaseline& baseline : replayed.baselines) {
        maps.push_back(
            evaluateBaseline(*baseline.map, replayed.testPoints, replayed.unseen));
        maps.back().name = baseline.name;
        addCost(baseline.cost, maps.back());
    }
    return maps;
}

std::vector<MapFigures> evaluateReplayed(const Replayed& replayed) {
    std::vector<MapFigures> maps = evaluateBaselines(replayed);
    maps.insert(maps.begin(), ours("hgmm",
                                   evaluateMap(replayed.map->model(), replayed.testPoints,
                                               replayed.run.split.seed, replayed.unseen),
                                   replayed));
    return maps;
}

MapFigures evaluateSurfaceOf(const Replayed& replayed) {
    return ours("hgmm surface", evaluateSurface(replayed.map->model(), replayed.testPoints),
                replayed);
}

View reportView(SensorKind sensor) {
    View view;
    view.yaw_deg = 35.0;
    view.pitch_deg = 40.0;
    // Depth cameras see rooms from within, whose near walls would hide the rest.
    view.cut = sensor == SensorKind::depthCamera ? 0.3 : 0.0;
    view.width_px = 900;
    return view;
}

ReportPicture pictureOfInput(const Replayed& replayed, const View& view,
                             const Frame& frame) {
    return {"Input",
            format("%zu of the points that the maps were given", replayed.input_map.size()),
            renderPoints(replayed.input_map, view, frame)};
}

std::vector<ReportPicture> picturesOf(const Replayed& replayed) {
    const View view = reportView(sensorKindOf(replayed.run.sensor));
    const hgmm::Map& map = replayed.map->model();
    if (replayed.input_map.empty() || map.empty()) return {};
    const Frame frame = frameOf(replayed.input_map, view);
    return {
        pictureOfInput(replayed, view, frame),
        {"Map", format("its %zu Gaussians of surfaces, to 2 sigma", map.mixture(0).size()),
         renderEllipsoids(map.mixture(0), view, map.origin(), frame)}};
}

void writeReport(const Replayed& replayed, const std::vector<MapFigures>& maps,
                 const std::string& folder, const std::vector<ReportPicture>& pictures) {
    hgmm::mrpt_bridge::writeFile(folder + "/metrics.json",
                                 metricsJson(replayed.run, maps).dump(2) + "\n");
    hgmm::mrpt_bridge::writeFile(folder + "/report.html",
                                 htmlReport(replayed.run, maps, pictures));
    if (!maps.front().occupancy) return;
    hgmm::mrpt_bridge::writeFile(folder + "/roc.svg", toSvg(rocPlot(maps)));
    hgmm::mrpt_bridge::writeFile(folder + "/reliability.svg", toSvg(reliabilityPlot(maps)));
    hgmm::mrpt_bridge::writeFile(folder + "/levels.svg", toSvg(levelsPlot(maps)));
}

}  // namespace replay
