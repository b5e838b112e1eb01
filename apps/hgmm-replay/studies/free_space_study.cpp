#include "studies/free_space_study.h"

#include <cstdio>
#include <stdexcept>
#include <vector>

#include "interrupt.h"
#include "map_setup.h"
#include "occupancy_table.h"
#include "replay_scans.h"
#include "report.h"
#include "studies/thesis_free_space.h"

namespace replay {

using namespace hgmm::evaluation;

void freeSpaceStudy(Recording& recording, const Options& options) {
    auto map = makeMap(options.config);
    std::vector<ReplayedBaseline> thesis;
    thesis.push_back({"perComponent",
                      std::make_unique<ThesisFreeSpace>(map->insertionOptions.params),
                      {}});
    const Replayed replayed =
        replayScans(recording, std::move(map), options, std::move(thesis));
    if (comparisonStopped()) return;
    if (replayed.run.scansMapped == 0)
        throw std::runtime_error(options.log + ": no scan was left to build a map from");
    if (replayed.testPoints.empty())
        throw std::runtime_error(options.log +
                                 ": no test points were held out for study free-space");
    std::vector<MapFigures> maps = evaluateReplayed(replayed);
    maps.front().name = "slabs";
    std::printf("study free-space: %zu scans mapped, %zu tested\n",
                replayed.run.scansMapped, replayed.run.scansTested);
    std::fputs(occupancyTable(replayed.run, maps).c_str(), stdout);
    if (options.reportFolder) writeReport(replayed, maps, options);
}

}  // namespace replay
