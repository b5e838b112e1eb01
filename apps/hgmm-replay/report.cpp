#include "report.h"

#include "hgmm/evaluation/metrics_json.h"
#include "hgmm/evaluation/occupancy_plots.h"

namespace replay {

using namespace hgmm::evaluation;

std::vector<MapFigures> evaluateReplayed(const Replayed& replayed) {
    std::vector<MapFigures> maps;
    maps.push_back(
        evaluateMap(replayed.map->model(), replayed.testPoints, replayed.run.split.seed));
    maps.back().name = "hgmm";
    maps.back().className = replayed.map->GetRuntimeClass()->className;
    maps.back().scanTime_ms = summariseTimes(replayed.insert_ms);
    for (const ReplayedBaseline& baseline : replayed.baselines) {
        maps.push_back(evaluateBaseline(*baseline.map, replayed.testPoints));
        maps.back().name = baseline.name;
        maps.back().scanTime_ms = summariseTimes(baseline.insert_ms);
    }
    return maps;
}

void writeReport(const Run& run, const std::vector<MapFigures>& maps,
                 const std::string& folder) {
    writeTextFile(folder + "/metrics.json", metricsJson(run, maps).dump(2) + "\n");
    if (!maps.front().occupancy) return;
    writeTextFile(folder + "/roc.svg", toSvg(rocPlot(maps)));
    writeTextFile(folder + "/reliability.svg", toSvg(reliabilityPlot(maps)));
    writeTextFile(folder + "/levels.svg", toSvg(levelsPlot(maps)));
}

}  // namespace replay
