#include "hgmm/evaluation/metrics_json.h"

#include <algorithm>
#include <cmath>

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
            {"near_m", {run.nearBand.min_m, run.nearBand.max_m}},
            {"free_band_m", {run.freeBand.fromSensor_m, run.freeBand.beforeHit_m}},
            {"range_noise_m", run.rangeNoise_m},
            {"threads", run.threads}};
}

Json levelJson(const LevelFigures& level) {
    Json json{{"level", level.level},
              {"components", level.components},
              {"components_free", level.componentsFree},
              {"bytes", level.bytes},
              {"kl_to_level0", level.klToLevel0}};
    if (level.aucNear) json["auc_near"] = *level.aucNear;
    if (level.aucUniform) json["auc_uniform"] = *level.aucUniform;
    return json;
}

void addUnseen(const UnseenFigures& f, Json& json) {
    json["unseen_points_behind_hits"] = f.behindHits;
    json["unseen_points_in_box"] = f.inBox;
    json["unseen_called_free_behind_hits"] = f.calledFreeBehindHits;
    json["unseen_called_free_in_box"] = f.calledFreeInBox;
    json["unseen_called_occupied"] = f.calledOccupied;
    json["unseen_mean_p_unknown"] = f.meanUnknown;
    json["seen_points"] = f.free;
    json["seen_called_unknown"] = f.seenCalledUnknown;
}

/// Pairs of false and true positive rates, close enough for a drawing.
Json rocJson(const RocCurve& curve) {
    constexpr double step = 0.005;
    Json json = Json::array();
    for (const RocPoint& p : thinned(curve, step)) json.push_back({p.fpr, p.tpr});
    return json;
}

/// Pairs of a false positive rate from 1e-4 on, evenly on a logarithmic axis, and the true
/// positive rate there.
Json logarithmicRocJson(const RocCurve& curve) {
    constexpr double decades = 4.0, step = 0.04;
    Json json = Json::array();
    if (curve.empty()) return json;
    for (double x = -decades; x < 0.5 * step; x += step) {
        const double fpr = std::min(1.0, std::pow(10.0, x));
        json.push_back({fpr, tprAt(curve, fpr)});
    }
    return json;
}

const char* nameOf(Meaning meaning) {
    switch (meaning) {
        case Meaning::occupancy:
            return "occupancy";
        case Meaning::surfaceLikelihood:
            return "surface_likelihood";
        case Meaning::nearness:
            return "nearness";
    }
    return "";
}

/// What only a probability of occupancy can be asked for.
void addCalibration(const OccupancyFigures& f, Json& json) {
    json["balanced_accuracy_near"] = f.balancedAccuracyNear;
    json["brier"] = f.brier;
    json["log_loss"] = f.logLoss;
    json["ece"] = f.ece;
    json["reliability"] = Json::array();
    for (const ReliabilityBin& bin : f.reliability)
        json["reliability"].push_back({bin.meanProbability, bin.occupiedShare});
}

void addOccupancy(const OccupancyFigures& f, Json& json) {
    json["hits"] = f.hits;
    json["uniform_free_points"] = f.uniformFree;
    json["near_free_points"] = f.nearFree;
    json["auc_uniform"] = f.aucUniform;
    json["auc_near"] = f.aucNear;
    json["tpr_at_fpr_1pct"] = tprAt(f.rocUniform, 0.01);
    json["tpr_at_fpr_5pct"] = tprAt(f.rocUniform, 0.05);
    json["tpr_at_fpr_1pct_near"] = tprAt(f.rocNear, 0.01);
    json["tpr_at_fpr_5pct_near"] = tprAt(f.rocNear, 0.05);
    json["unknown_share_hit"] = f.unknownShareHit;
    json["unknown_share_free"] = f.unknownShareFree;
    json["unknown_share_near"] = f.unknownShareNear;
    json["queries_per_s"] = f.queriesPerSecond;
    json["roc"] = rocJson(f.rocUniform);
    json["roc_near"] = rocJson(f.rocNear);
    json["tpr_at_log_fpr"] = logarithmicRocJson(f.rocUniform);
}

Json mapJson(const MapFigures& map) {
    Json json{{"name", map.name},
              {"class", map.className},
              {"source", map.source},
              {"score", nameOf(map.meaning)},
              {"ranked", map.ranked}};
    for (const auto& [key, value] : map.options) json["options"][key] = value;
    if (map.occupancy) addOccupancy(*map.occupancy, json);
    if (map.occupancy && map.meaning == Meaning::occupancy)
        addCalibration(*map.occupancy, json);
    if (map.unseen) addUnseen(*map.unseen, json);
    if (map.logLikelihoodOfHits) json["loglik_hit"] = *map.logLikelihoodOfHits;
    if (map.reconstruction) {
        json["accuracy_m"] = map.reconstruction->accuracy_m;
        json["completeness_m"] = map.reconstruction->completeness_m;
        json["chamfer_m"] = map.reconstruction->chamfer_m;
        json["f1_5cm"] = map.reconstruction->f1;
    }
    if (map.memory.serialized_bytes)
        json["bytes_serialized"] = *map.memory.serialized_bytes;
    json["bytes_live"] = map.memory.live_bytes;
    if (!map.levels.empty()) {
        json["components_surface"] = map.levels.front().components;
        json["components_free"] = map.levels.front().componentsFree;
    }
    json["scan_ms_median"] = map.scanTime_ms.median;
    json["scan_ms_p99"] = map.scanTime_ms.p99;
    json["scan_ms_worst"] = map.scanTime_ms.worst;
    json["scan_ms_first_tenth"] = map.scanTime_ms.firstTenth;
    json["scan_ms_last_tenth"] = map.scanTime_ms.lastTenth;
    json["scan_ms"] = map.insert_ms;
    json["bytes_live_over_run"] = Json::array();
    for (const auto& [scans, bytes] : map.liveBytesOverRun)
        json["bytes_live_over_run"].push_back({scans, bytes});
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

}  // namespace hgmm::evaluation
