#include "hgmm/evaluation/metrics_json.h"

#include <filesystem>
#include <fstream>
#include <stdexcept>

namespace hgmm::evaluation {
namespace {

using Json = nlohmann::ordered_json;

Json datasetJson(const Run& run) {
    Json json{{"name", run.dataset},
              {"scans_mapped", run.scansMapped},
              {"scans_tested", run.scansTested},
              {"points_per_scan", run.pointsPerScan},
              {"sensor", run.sensor}};
    if (run.interrupted) json["interrupted"] = true;
    return json;
}

Json protocolJson(const Run& run) {
    return {{"split", run.split.every},
            {"subsample", run.split.subsample},
            {"holdout_points", run.split.holdoutPoints},
            {"queries_per_scan", run.queriesPerScan},
            {"seed", run.split.seed},
            {"threads", run.threads}};
}

Json levelJson(const LevelFigures& level) {
    return {{"level", level.level},
            {"components", level.components},
            {"bytes", level.bytes},
            {"kl_to_level0", level.klToLevel0}};
}

Json mapJson(const MapFigures& map) {
    Json json{{"name", map.name}, {"class", map.className}};
    for (const auto& [key, value] : map.options) json["options"][key] = value;
    if (map.logLikelihoodOfHits) json["loglik_hit"] = *map.logLikelihoodOfHits;
    if (map.reconstruction) {
        json["accuracy_m"] = map.reconstruction->accuracy_m;
        json["completeness_m"] = map.reconstruction->completeness_m;
        json["chamfer_m"] = map.reconstruction->chamfer_m;
        json["f1_5cm"] = map.reconstruction->f1;
    }
    json["bytes_serialized"] = map.memory.serialized_bytes;
    json["bytes_live"] = map.memory.live_bytes;
    json["components_surface"] = map.levels.empty() ? 0 : map.levels.front().components;
    json["scan_ms_median"] = map.scanTime_ms.median;
    json["scan_ms_p99"] = map.scanTime_ms.p99;
    json["scan_ms_worst"] = map.scanTime_ms.worst;
    json["scan_ms_first_tenth"] = map.scanTime_ms.firstTenth;
    json["scan_ms_last_tenth"] = map.scanTime_ms.lastTenth;
    if (map.likelihoodsPerSecond) json["likelihoods_per_s"] = *map.likelihoodsPerSecond;
    json["levels"] = Json::array();
    for (const LevelFigures& level : map.levels) json["levels"].push_back(levelJson(level));
    return json;
}

}  // namespace

Json metricsJson(const Run& run, const std::vector<MapFigures>& maps) {
    Json json{{"dataset", datasetJson(run)}, {"protocol", protocolJson(run)}};
    json["maps"] = Json::array();
    for (const MapFigures& map : maps) json["maps"].push_back(mapJson(map));
    return json;
}

void writeTextFile(const std::string& file, const std::string& text) {
    const std::string partial = file + ".partial";
    std::ofstream out(partial, std::ios::binary);
    out << text;
    out.close();
    std::error_code error;
    if (out) std::filesystem::rename(partial, file, error);
    if (!out || error) {
        std::filesystem::remove(partial, error);
        throw std::runtime_error(file +
                                 ": cannot be written; is there such a folder, and space?");
    }
}

}  // namespace hgmm::evaluation
