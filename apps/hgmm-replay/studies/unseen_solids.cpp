#include "studies/unseen_solids.h"

#include "hgmm/evaluation/free_points.h"
#include "hgmm/evaluation/split.h"
#include "hgmm/evaluation/timing.h"
#include "interrupt.h"
#include "studies/dynamics_world.h"

namespace replay {
namespace {

using namespace hgmm::evaluation;
using namespace hgmm::evaluation::solid_room;

constexpr double kRangeNoise_m = 0.01;

/// Points that the rays of an ideal view passed.
void addPassed(const std::vector<SurfacePoint>& view, const hgmm::Pose& T_map_sensor,
               std::uint64_t seed, std::size_t scan, Points& passed_map) {
    constexpr std::size_t kPerScan = 200;
    std::mt19937_64 stream = randomStream(seed, scan, Draw::uniformFree);
    for (const std::size_t i :
         chooseIndices(view.size(), kPerScan, seed, scan, Draw::view)) {
        const Eigen::Vector3d ray = view[i].point_map - T_map_sensor.t;
        if (const auto range_m = rangeIn(FreeBand{}, ray.norm(), nextUniform(stream)))
            passed_map.push_back(T_map_sensor.t + *range_m * ray.normalized());
    }
}

}  // namespace

FigureTable solidsTable() {
    using Worst = FigureColumn::Worst;
    std::vector<FigureColumn> columns;
    const char* const keys[] = {"free_in_box_02",    "free_in_box_05",
                                "free_in_box_12",    "free_in_pillars",
                                "free_behind_walls", "free_beyond_corners"};
    const char* const headings[] = {"box .2",  "box .5", "box 1.2",
                                    "pillars", "walls",  "corners"};
    const char* const goals[] = {"0", "0", "0", "0", "<=.002", "<=.002"};
    for (int i = 0; i < 6; ++i)
        columns.push_back({headings[i], keys[i], 4, Worst::largest, goals[i]});
    columns.push_back({"solids P<.5", "below_half_in_solids", 4, Worst::largest});
    columns.push_back({"seen unknown", "seen_called_unknown", 4, Worst::largest});
    columns.push_back({"ms/scan", "scan_ms_median", 1, Worst::largest});
    return {
        "solids",
        "Solids: share of points called free inside boxes and pillars, behind walls and "
        "beyond corners",
        {"sensor", "route", "scans", "map"},
        std::move(columns)};
}

void studySolids(const std::string& sensorName, Route route, int scans, std::uint64_t seed,
                 const MakeMaps& makeMaps, FigureTable& table) {
    constexpr std::size_t kPoints = 2000, kInSolids = 4;
    const SimulatedSensor sensor = observerOf(sensorName).sensor;
    const Scene scene = room();
    const auto maps = makeMaps();
    Points passed_map;
    std::size_t scan = 0;
    double height_m = 0.0;
    for (const hgmm::Pose& T_map_sensor : poses(route, scans)) {
        if (interrupted()) return;
        const auto returns =
            simulateReturns(scene, sensor, T_map_sensor, {kRangeNoise_m}, seed, scan);
        for (const auto& map : maps)
            map->insert(scanOf(returns, sensor, T_map_sensor, WithoutReturn::leftOut));
        addPassed(idealView(scene, sensor, T_map_sensor), T_map_sensor, seed, scan++,
                  passed_map);
        if (sensorName == "2d") height_m = T_map_sensor.t.z();
    }
    const auto hidden = hiddenPoints(kPoints, height_m, seed);
    const auto isFree = [](const hgmm::Occupancy& o) { return o.free > 0.5F; };
    const auto isUnknown = [](const hgmm::Occupancy& o) { return o.unknown > 0.5F; };
    for (const auto& map : maps) {
        std::vector<double> figures;
        double belowHalf = 0.0;
        for (std::size_t i = 0; i < hidden.size(); ++i) {
            const auto answers = map->occupancy(hidden[i].points_map);
            figures.push_back(shareOf(answers, isFree));
            if (i < kInSolids) belowHalf += shareOf(answers, saysFree) / double(kInSolids);
        }
        figures.push_back(belowHalf);
        figures.push_back(shareOf(map->occupancy(passed_map), isUnknown));
        figures.push_back(median(map->insert_ms()));
        table.add({sensorName, route == Route::round ? "round" : "through",
                   std::to_string(scans), map->name()},
                  figures);
    }
}

}  // namespace replay
