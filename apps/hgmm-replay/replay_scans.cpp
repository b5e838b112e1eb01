#include "replay_scans.h"

#include <chrono>
#include <filesystem>

#include "hgmm/evaluation/range_noise.h"
#include "hgmm/mrpt_bridge/observation_to_scan.h"
#include "interrupt.h"
#include "progress.h"

namespace replay {
namespace {

using namespace hgmm::evaluation;
using Clock = std::chrono::steady_clock;

double millisecondsSince(Clock::time_point start) {
    return std::chrono::duration<double, std::milli>(Clock::now() - start).count();
}

template <class Insert>
void timed(std::vector<double>& durations_ms, const Insert& insert) {
    const Clock::time_point start = Clock::now();
    insert();
    durations_ms.push_back(millisecondsSince(start));
}

/// Empty maps, and how they are to be tested.
Replayed prepare(const Recording& recording,
                 std::unique_ptr<mrpt::maps::CHGMMOccupancyMap> map,
                 const Options& options) {
    const NearBand near = options.near.value_or(nearBandOf(recording.sensor()));
    Replayed replayed{
        std::move(map), {}, {}, TestPoints(options.split.seed, near, options.free), {}, {}};
    for (const std::string& name : options.baselines)
        replayed.baselines.push_back({name, makeBaseline(name), {}});
    Run& run = replayed.run;
    run.dataset = std::filesystem::path(options.log).stem().string();
    run.sensor = recording.sensor();
    run.split = options.split;
    run.queriesPerScan = TestPoints::kQueriesPerScan;
    run.nearBand = near;
    run.freeBand = options.free;
    run.rangeNoise_m = options.rangeNoise_m;
    run.threads = options.threads;
    return replayed;
}

/// Lets the map or the test have the points of one scan.
void useScan(hgmm::Scan scan, std::size_t index, Replayed& replayed) {
    Run& run = replayed.run;
    if (run.split.isTestScan(index)) {
        ++run.scansTested;
        replayed.testPoints.add(scan, index);
        return;
    }
    ++run.scansMapped;
    SplitScan parts = splitPoints(std::move(scan), index, run.split);
    if (run.rangeNoise_m > 0.0)
        addRangeNoise(parts.mapping, run.rangeNoise_m, run.split.seed, index);
    replayed.testPoints.add(parts.heldOut, index);
    timed(replayed.insert_ms, [&] { replayed.map->insertScan(parts.mapping); });
    for (ReplayedBaseline& baseline : replayed.baselines)
        timed(baseline.insert_ms, [&] { baseline.map->insert(parts.mapping); });
}

}  // namespace

Replayed replayScans(Recording& recording,
                     std::unique_ptr<mrpt::maps::CHGMMOccupancyMap> map,
                     const Options& options) {
    Replayed replayed = prepare(recording, std::move(map), options);
    Run& run = replayed.run;
    std::size_t points = 0;
    Progress progress(recording.size(), options.quiet);
    while (const std::optional<RecordedScan> recorded = recording.next()) {
        const Clock::time_point start = Clock::now();
        std::optional<hgmm::Scan> scan = hgmm::mrpt_bridge::observationToScan(
            *recorded->observation, recorded->T_map_robot);
        replayed.conversion_ms.push_back(millisecondsSince(start));
        if (scan) {
            points += scan->size();
            useScan(std::move(*scan), recorded->index, replayed);
        }
        progress.advance();
        run.interrupted = interrupted();
        if (run.interrupted) break;
    }
    const std::size_t scans = run.scansMapped + run.scansTested;
    if (scans > 0)
        run.pointsPerScan = static_cast<double>(points) / static_cast<double>(scans);
    return replayed;
}

}  // namespace replay
