#include "report.h"

#include <utility>

#include "hgmm/evaluation/metrics_json.h"
#include "hgmm/evaluation/ply.h"

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

Ply pointsOnly(const Points& points_map) {
    Ply ply;
    ply.vertices = points_map;
    return ply;
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

void writeReport(const Replayed& replayed, const std::vector<MapFigures>& maps,
                 const Options& options, const std::vector<PointPicture>& pictures) {
    const std::string& folder = *options.reportFolder;
    nlohmann::ordered_json metrics = metricsJson(replayed.run, maps);
    metrics["view"]["map"] = kReportMap;
    replayed.map->saveToFile(folder + "/" + kReportMap);
    if (!replayed.input_map.empty()) {
        metrics["view"]["points"] = kReportPoints;
        writePly(folder + "/" + kReportPoints, pointsOnly(replayed.input_map));
    }
    writeReportFiles(std::move(metrics), options, pictures);
}

}  // namespace replay
