#include "replay_scans.h"

#include <algorithm>
#include <chrono>
#include <filesystem>

#include "format.h"
#include "hgmm/evaluation/configured_baselines.h"
#include "hgmm/evaluation/points.h"
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

template <class Insert, class LiveBytes>
void insertAndMeasure(InsertionCost& cost, std::size_t scansBetweenSizes,
                      const Insert& insert, const LiveBytes& liveBytes) {
    const Clock::time_point start = Clock::now();
    insert();
    cost.insert_ms.push_back(millisecondsSince(start));
    const std::size_t scans = cost.insert_ms.size();
    if (scans % scansBetweenSizes == 0) cost.liveBytes.emplace_back(scans, liveBytes());
}

/// "octomap" becomes "octomap:0.05".
std::string nameOf(const std::string& specification, const Baseline& map) {
    const auto options = map.options();
    if (specification.find(':') != std::string::npos || options.empty() ||
        options.front().first != "resolution")
        return specification;
    return specification + format(":%g", options.front().second);
}

std::vector<ReplayedBaseline> makeBaselines(const Options& options, SensorKind sensor,
                                            std::vector<ReplayedBaseline> baselines) {
    for (const std::string& specification : options.baselines) {
        std::unique_ptr<Baseline> map = makeBaseline(specification, sensor);
        const std::string name = nameOf(specification, *map);
        baselines.push_back({name, std::move(map), {}});
    }
    if (options.config)
        for (auto& [name, map] : configuredBaselines(*options.config))
            baselines.push_back({name, std::move(map), {}});
    return baselines;
}

/// Empty maps, and how they are to be tested.
Replayed prepare(const Recording& recording, mrpt::maps::CHGMMOccupancyMap::Ptr map,
                 const Options& options, std::vector<ReplayedBaseline> others) {
    const NearBand near = options.near.value_or(nearBandOf(recording.sensor()));
    Replayed replayed{
        std::move(map),
        makeBaselines(options, sensorKindOf(recording.sensor()), std::move(others)),
        {},
        TestPoints(options.split.seed, near, options.free),
        SeenSpace(options.split.seed),
        {},
        {},
        {},
        {}};
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

/// How much of a run is kept to be looked at.
struct Sampling {
    explicit Sampling(std::size_t scans)
        : scansBetweenSizes(std::max<std::size_t>(1, scans / 20)),
          pointsPerScan(
              std::max<std::size_t>(1, 300000 / std::max<std::size_t>(1, scans))) {}

    /// Which of the points of a scan, evenly over their order.
    std::vector<std::size_t> pointsOf(std::size_t points) const {
        std::vector<std::size_t> indices;
        const std::size_t stride = std::max<std::size_t>(1, points / pointsPerScan);
        for (std::size_t i = 0; i < points; i += stride) indices.push_back(i);
        return indices;
    }

    std::size_t scansBetweenSizes;  ///< between measurements of live bytes
    std::size_t pointsPerScan;      ///< of input
};

/// Lets the map or the test have the points of one scan.
void useScan(hgmm::Scan scan, std::size_t index, const Sampling& sampling,
             Replayed& replayed) {
    Run& run = replayed.run;
    replayed.seen.add(scan, index);
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
    appendPoints(parts.mapping, sampling.pointsOf(parts.mapping.size()),
                 replayed.input_map);
    insertAndMeasure(
        replayed.cost, sampling.scansBetweenSizes,
        [&] { replayed.map->insertScan(parts.mapping); },
        [&] { return replayed.map->model().liveBytes(); });
    for (ReplayedBaseline& baseline : replayed.baselines)
        insertAndMeasure(
            baseline.cost, sampling.scansBetweenSizes,
            [&] { baseline.map->insert(parts.mapping); },
            [&] { return baseline.map->liveBytes(); });
}

}  // namespace

Replayed replayScans(Recording& recording, mrpt::maps::CHGMMOccupancyMap::Ptr map,
                     const Options& options, std::vector<ReplayedBaseline> others) {
    Replayed replayed = prepare(recording, std::move(map), options, std::move(others));
    Run& run = replayed.run;
    const Sampling sampling(recording.size());
    std::size_t points = 0;
    Progress progress(recording.size(), options.quiet);
    while (const std::optional<RecordedScan> recorded = recording.next()) {
        const Clock::time_point start = Clock::now();
        auto& insertion = replayed.map->insertionOptions;
        if (!insertion.params.modalities.empty())
            hgmm::mrpt_bridge::settleIntensityScale(*recorded->observation,
                                                    insertion.reading);
        std::optional<hgmm::Scan> scan = hgmm::mrpt_bridge::observationToScan(
            *recorded->observation, recorded->T_map_robot,
            hgmm::mrpt_bridge::channelsFor(insertion.params), insertion.reading);
        replayed.conversion_ms.push_back(millisecondsSince(start));
        if (scan) {
            points += scan->size();
            useScan(std::move(*scan), recorded->index, sampling, replayed);
        }
        progress.advance();
        run.interrupted = interrupted();
        if (run.interrupted) break;
    }
    replayed.unseen = replayed.seen.draw(options.free);
    const std::size_t scans = run.scansMapped + run.scansTested;
    if (scans > 0)
        run.pointsPerScan = static_cast<double>(points) / static_cast<double>(scans);
    return replayed;
}

}  // namespace replay
