#include "replay_scans.h"

#include <chrono>
#include <filesystem>

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

/// Lets the map or the test have the points of one scan.
void useScan(hgmm::Scan scan, std::size_t index, Replayed& replayed) {
    Run& run = replayed.run;
    if (run.split.isTestScan(index)) {
        ++run.scansTested;
        replayed.testPoints.add(scan, index);
        return;
    }
    ++run.scansMapped;
    const SplitScan parts = splitPoints(std::move(scan), index, run.split);
    replayed.testPoints.add(parts.heldOut, index);
    const Clock::time_point start = Clock::now();
    replayed.map->insertScan(parts.mapping);
    replayed.insert_ms.push_back(millisecondsSince(start));
}

}  // namespace

Replayed replayScans(Recording& recording,
                     std::unique_ptr<mrpt::maps::CHGMMOccupancyMap> map,
                     const Options& options) {
    Replayed replayed{std::move(map), {}, TestPoints(options.split.seed), {}, {}};
    Run& run = replayed.run;
    run.dataset = std::filesystem::path(options.log).stem().string();
    run.sensor = recording.sensor();
    run.split = options.split;
    run.queriesPerScan = TestPoints::kQueriesPerScan;
    run.threads = options.threads;

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
