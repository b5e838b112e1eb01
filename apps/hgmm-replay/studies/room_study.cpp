#include "studies/room_study.h"

#include <cstdio>
#include <stdexcept>
#include <vector>

#include "format.h"
#include "hgmm/evaluation/room_figures.h"
#include "hgmm/mrpt_bridge/observation_to_scan.h"
#include "hgmm/mrpt_bridge/output_file.h"
#include "interrupt.h"
#include "map_setup.h"
#include "replay_scans.h"

namespace replay {
namespace {

using namespace hgmm::evaluation;

struct Rays {
    std::vector<Ray> all, ofTestScans;
};

Rays readRays(Recording& recording, const SplitParams& split) {
    Rays rays;
    while (const auto recorded = recording.next()) {
        const auto scan = hgmm::mrpt_bridge::observationToScan(*recorded->observation,
                                                               recorded->T_map_robot);
        if (!scan) continue;
        const hgmm::Pose& T_map_sensor = scan->T_map_sensor;
        for (std::size_t i = 0; i < scan->size(); ++i) {
            const Eigen::Vector3d p_sensor(scan->x[i], scan->y[i], scan->z[i]);
            if (!p_sensor.allFinite() || p_sensor.isZero()) continue;
            rays.all.push_back(
                {T_map_sensor.t, T_map_sensor.R * p_sensor + T_map_sensor.t});
            if (split.isTestScan(recorded->index))
                rays.ofTestScans.push_back(rays.all.back());
        }
    }
    return rays;
}

std::string summary(const Run& run, const Box& room, const hgmm::Map& map,
                    std::size_t bytes, const RoomFigures& f) {
    const Eigen::Vector3d size = room.high - room.low;
    std::string text = format(
        "study room: %.2f x %.2f x %.2f m; %zu scans mapped with range noise of %g m, %zu "
        "tested\n",
        size.x(), size.y(), size.z(), run.scansMapped, run.rangeNoise_m, run.scansTested);
    text += format("%zu surface and %zu free components, %.1f KB\n", map.mixture().size(),
                   map.freeMixture().size(), static_cast<double>(bytes) / 1000.0);
    text += format("walls           P(occ) > 0.5      %.4f of %zu points\n", f.wallOccupied,
                   f.wallPoints);
    text += format(
        "before walls    P(occ) < 0.5      %.4f of %zu points more than %g m from "
        "each\n",
        f.freeNotOccupied, f.freePoints, RoomFigures::kBeforeWalls_m);
    text += format("                P(unknown) > 0.5  %.4f of them\n", f.freeUnknown);
    return text + format(
                      "behind walls    P(unknown) > 0.5  %.4f of %zu points %g to %g m "
                      "behind\n",
                      f.hiddenUnknown, f.hiddenPoints, RoomFigures::kBehind_m[0],
                      RoomFigures::kBehind_m[1]);
}

nlohmann::ordered_json json(const Run& run, const RoomFigures& f) {
    return {{"scans_mapped", run.scansMapped},        {"scans_tested", run.scansTested},
            {"range_noise_m", run.rangeNoise_m},      {"wall_points", f.wallPoints},
            {"wall_occupied", f.wallOccupied},        {"free_points", f.freePoints},
            {"free_not_occupied", f.freeNotOccupied}, {"free_unknown", f.freeUnknown},
            {"hidden_points", f.hiddenPoints},        {"hidden_unknown", f.hiddenUnknown}};
}

Box roomIn(const std::string& log, const Rays& rays) {
    try {
        return roomOf(rays.all);
    } catch (const std::invalid_argument& e) {
        throw std::runtime_error(log + ": " + e.what());
    }
}

}  // namespace

void roomStudy(Recording& recording, const RecordingOptions& recordingOptions,
               const Options& options) {
    Recording again(options.log, recordingOptions);
    const Rays rays = readRays(again, options.split);
    if (rays.ofTestScans.empty())
        throw std::runtime_error(options.log + ": no test scan was left for study room");
    const Box room = roomIn(options.log, rays);
    const Replayed replayed = replayScans(recording, makeMap(options.config), options);
    if (interrupted()) {
        std::fputs("interrupted: the room was not evaluated\n", stderr);
        return;
    }
    if (replayed.map->model().empty())
        throw std::runtime_error(options.log + ": no scan was left to build a map from");
    const std::vector<std::uint8_t> saved = replayed.map->model().save();
    const hgmm::Map map = hgmm::Map::load(saved.data(), saved.size());
    const RoomFigures figures =
        evaluateRoom(map, rays.ofTestScans, room, options.split.seed);
    std::fputs(summary(replayed.run, room, map, saved.size(), figures).c_str(), stdout);
    if (options.reportFolder)
        hgmm::mrpt_bridge::writeFile(*options.reportFolder + "/room.json",
                                     json(replayed.run, figures).dump(2) + "\n");
}

}  // namespace replay
