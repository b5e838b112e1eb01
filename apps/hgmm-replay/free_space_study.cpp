#include "free_space_study.h"

#include <cstdio>
#include <stdexcept>
#include <vector>

#include "hgmm/free_space.h"
#include "interrupt.h"
#include "map_setup.h"
#include "occupancy_table.h"
#include "replay_scans.h"
#include "report.h"

namespace replay {
namespace {

using namespace hgmm::evaluation;
using hgmm::FreeSpaceModel;

Replayed replayWith(FreeSpaceModel model, Recording& recording, const Options& options) {
    auto map = makeMap(options.config);
    map->insertionOptions.params.occupancy.freeSpace.freeSpaceModel =
        static_cast<int>(model);
    return replayScans(recording, std::move(map), options);
}

}  // namespace

void freeSpaceStudy(Recording& recording, const RecordingOptions& recordingOptions,
                    const Options& options) {
    const Replayed slabs = replayWith(FreeSpaceModel::slabs, recording, options);
    if (comparisonStopped()) return;
    if (slabs.run.scansMapped == 0)
        throw std::runtime_error(options.log + ": no scan was left to build a map from");
    if (slabs.testPoints.empty())
        throw std::runtime_error(options.log +
                                 ": no test points were held out for study free-space");
    Options withoutBaselines = options;
    withoutBaselines.baselines.clear();
    Recording again(options.log, recordingOptions);
    const Replayed perComponent =
        replayWith(FreeSpaceModel::perComponent, again, withoutBaselines);
    if (comparisonStopped()) return;

    std::vector<MapFigures> maps = evaluateReplayed(slabs);
    maps.front().name = "slabs";
    maps.insert(maps.begin() + 1, evaluateReplayed(perComponent).front());
    maps[1].name = "perComponent";
    std::printf("study free-space: %zu scans mapped, %zu tested\n", slabs.run.scansMapped,
                slabs.run.scansTested);
    std::fputs(occupancyTable(slabs.run, maps).c_str(), stdout);
    if (options.reportFolder)
        writeReport(slabs, maps, *options.reportFolder, picturesOf(slabs));
}

}  // namespace replay
