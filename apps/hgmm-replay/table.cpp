#include "table.h"

#include "format.h"
#include "occupancy_table.h"

namespace replay {
namespace {

using namespace hgmm::evaluation;

double kilobytes(std::size_t bytes) {
    return static_cast<double>(bytes) / 1000.0;
}

std::string times(const char* what, const Timing& t) {
    return format(
        "%-22s median %.2f, p99 %.2f, worst %.2f ms; first tenth %.2f, last %.2f ms\n",
        what, t.median, t.p99, t.worst, t.firstTenth, t.lastTenth);
}

/// What only a mixture of surfaces can be asked for.
std::string surface(const MapFigures& map) {
    std::string text;
    if (map.logLikelihoodOfHits)
        text += format("%-22s %.3f nat/point\n", "held-out likelihood",
                       *map.logLikelihoodOfHits);
    if (map.reconstruction) {
        const Reconstruction& r = *map.reconstruction;
        text += format("%-22s accuracy %.2f cm, completeness %.2f cm, Chamfer %.2f cm\n",
                       "reconstruction", 100 * r.accuracy_m, 100 * r.completeness_m,
                       100 * r.chamfer_m);
        text += format("%-22s %.4f (precision %.4f, recall %.4f)\n", "F1 at 5 cm", r.f1,
                       r.precision, r.recall);
    } else {
        text += "no test points: --split K or --holdout-points F measures accuracy too\n";
    }
    return text;
}

}  // namespace

std::string levelsTable(const MapFigures& map) {
    std::string text =
        "  level  surface      free        KB   KL to level 0 [nat]   AUC near  uniform\n";
    for (const LevelFigures& level : map.levels) {
        text += format("  %5zu  %7zu  %8zu  %8.1f   %-19.4f", level.level, level.components,
                       level.componentsFree, kilobytes(level.bytes), level.klToLevel0);
        if (level.aucNear && level.aucUniform)
            text += format("   %.4f    %.4f", *level.aucNear, *level.aucUniform);
        text += "\n";
    }
    return text;
}

std::string table(const Run& run, const std::vector<MapFigures>& maps,
                  const Timing& conversion_ms) {
    const MapFigures& map = maps.front();
    std::string text =
        run.dataset + format(": %zu scans mapped, %zu tested, %.0f points each, ",
                             run.scansMapped, run.scansTested, run.pointsPerScan);
    text += run.sensor + "\n\n" + map.name + "\n" + levelsTable(map) + "\n";
    text += format("%-22s serialised %.1f KB, live %.1f KB\n", "map",
                   kilobytes(map.memory.serialized_bytes.value_or(0)),
                   kilobytes(map.memory.live_bytes));
    text += times("insertion per scan", map.scanTime_ms);
    text += times("conversion per scan", conversion_ms);
    return text + surface(map) + occupancyTable(run, maps);
}

}  // namespace replay
