#include "occupancy_table.h"

#include <algorithm>

#include "format.h"

namespace replay {
namespace {

using namespace hgmm::evaluation;

std::string queriesNote(const Run& run, const OccupancyFigures& f) {
    std::string text =
        format("%zu hits; free points: %zu uniform (%g m after the sensor to %g m before ",
               f.hits, f.uniformFree, run.freeBand.fromSensor_m, run.freeBand.beforeHit_m);
    text += format("the hit), %zu near (%g to %g m before it)\n", f.nearFree,
                   run.nearBand.min_m, run.nearBand.max_m);
    const std::size_t shortForUniform = f.hits - f.uniformFree,
                      shortForNear = f.hits - f.nearFree;
    if (shortForUniform + shortForNear > 0)
        text += format(
            "left out: %zu rays too short for a uniform point, %zu for a near "
            "one\n",
            shortForUniform, shortForNear);
    return text;
}

/// Of maps whose answers are no probabilities, only what ranks points.
std::string accuracy(const MapFigures& map, int width) {
    const OccupancyFigures& f = *map.occupancy;
    const bool probabilities = map.meaning == Meaning::occupancy;
    std::string row =
        format("  %-*s  %.4f  %.4f   ", width, map.name.c_str(), f.aucUniform, f.aucNear);
    row += probabilities ? format("%.4f", f.balancedAccuracyNear) : format("%6s", "-");
    row +=
        format("    %.3f %.3f   %.3f %.3f", tprAt(f.rocUniform, 0.01),
               tprAt(f.rocUniform, 0.05), tprAt(f.rocNear, 0.01), tprAt(f.rocNear, 0.05));
    row += probabilities ? format("  %.4f  %.3f  %.4f", f.brier, f.logLoss, f.ece)
                         : format("  %6s  %5s  %6s", "-", "-", "-");
    return row + format("  %.3f  %.3f  %.3f\n", f.unknownShareHit, f.unknownShareFree,
                        f.unknownShareNear);
}

std::string unseen(const MapFigures& map, int width) {
    const UnseenFigures& f = *map.unseen;
    return format("  %-*s  %8.3f  %8.3f  %8.3f  %8.3f  %8.3f\n", width, map.name.c_str(),
                  100.0 * f.calledFreeBehindHits, 100.0 * f.calledFreeInBox,
                  100.0 * f.calledOccupied, f.meanUnknown, 100.0 * f.seenCalledUnknown);
}

std::string unseenTable(const std::vector<MapFigures>& maps, int width) {
    const UnseenFigures& f = *maps.front().unseen;
    std::string text =
        format("\nunseen: %zu points behind hits, %zu in the box around all; %zu seen\n",
               f.behindHits, f.inBox, f.free);
    text += format("  %-*s  called free [%%]    called    mean P(    seen called\n", width,
                   "map");
    text += format("  %-*s    behind    in box  occ. [%%]  unknown)  unknown [%%]\n", width,
                   "");
    for (const MapFigures& map : maps)
        if (map.unseen) text += unseen(map, width);
    return text;
}

std::string cost(const MapFigures& map, int width, const double* firstBaseline_ms) {
    const std::size_t bytes = countedBytes(map.memory);
    std::string row = format("  %-*s  %10.1f  %8.2f", width, map.name.c_str(),
                             static_cast<double>(bytes) / 1000.0, map.scanTime_ms.median);
    row += firstBaseline_ms && *firstBaseline_ms > 0.0
               ? format("  %8.2f", map.scanTime_ms.median / *firstBaseline_ms)
               : format("  %8s", "-");
    row += map.occupancy ? format("  %9.0f", map.occupancy->queriesPerSecond)
                         : format("  %9s", "-");
    if (!map.levels.empty())
        row += format("  %zu/%zu", map.levels.front().components,
                      map.levels.front().componentsFree);
    return row + "\n";
}

}  // namespace

std::string occupancyTable(const Run& run, const std::vector<MapFigures>& maps) {
    int width = 4;
    for (const MapFigures& map : maps)
        width = std::max(width, static_cast<int>(map.name.size()));
    std::string text;
    if (maps.front().occupancy) {
        text += "\noccupancy: " + queriesNote(run, *maps.front().occupancy);
        text += format(
            "  %-*s  AUC             bal. acc  TPR at 1, 5 %% FPR        Brier  "
            " log-   ECE     unknown share\n",
            width, "map");
        text += format(
            "  %-*s  unif.   near    near      unif.         near          "
            "       loss            hits   unif.  near\n",
            width, "");
        for (const MapFigures& map : maps)
            if (map.occupancy) text += accuracy(map, width);
    }
    if (maps.front().unseen) text += unseenTable(maps, width);
    // Ours come first, and have levels unless one is asked for its surfaces alone.
    const auto baseline =
        std::find_if(maps.begin() + 1, maps.end(),
                     [](const MapFigures& map) { return map.levels.empty(); });
    const double* firstBaseline_ms =
        baseline == maps.end() ? nullptr : &baseline->scanTime_ms.median;
    text += format("\n  %-*s          KB   ms/scan  ratio to  queries/s  components\n",
                   width, "map");
    text += format("  %-*s                median    %8s             surface/free\n", width,
                   "", firstBaseline_ms ? "baseline" : "");
    for (const MapFigures& map : maps) text += cost(map, width, firstBaseline_ms);
    return text;
}

}  // namespace replay
