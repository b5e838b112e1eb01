#include "studies/comparison_studies.h"

#include <algorithm>
#include <cstdio>
#include <numeric>
#include <stdexcept>
#include <utility>

#include "format.h"
#include "map_setup.h"
#include "occupancy_table.h"
#include "replay_scans.h"
#include "report.h"
#include "table.h"

namespace replay {
namespace {

using namespace hgmm::evaluation;

/// Replays with the study's usual baselines, unless the user names others.
Replayed replayFor(Recording& recording, Options options,
                   std::vector<std::string> usualBaselines) {
    if (options.baselines.empty()) options.baselines = std::move(usualBaselines);
    Replayed replayed = replayScans(recording, makeMap(options.config), options);
    if (replayed.run.scansMapped == 0)
        throw std::runtime_error(options.log + ": no scan was left to build a map from");
    return replayed;
}

void requireTestPoints(const Replayed& replayed, const Options& options) {
    if (replayed.testPoints.empty())
        throw std::runtime_error(options.log + ": no test points were held out for study " +
                                 options.study.value_or(""));
}

/// Prints what a study found, and writes the report of its run where one is wanted.
void conclude(const Replayed& replayed, const std::vector<MapFigures>& maps,
              const std::string& found, const Options& options) {
    const Run& run = replayed.run;
    std::printf("study %s: %s, %zu scans mapped, %zu tested%s\n%s",
                options.study.value_or("").c_str(), run.dataset.c_str(), run.scansMapped,
                run.scansTested, run.interrupted ? " (interrupted)" : "", found.c_str());
    if (options.reportFolder) writeReport(replayed, maps, options);
}

std::string memoryTable(const Run& run, const std::vector<MapFigures>& maps) {
    std::string text = format("  %-16s  %14s  %14s  %10s\n", "map", "memory [KB]",
                              "per scan [KB]", "times ours");
    const auto bytesOf = [](const MapFigures& map) {
        return static_cast<double>(countedBytes(map.memory));
    };
    for (const MapFigures& map : maps) {
        const double kilobytes = bytesOf(map) / 1000.0;
        text += format("  %-16s  %14.1f  %14.3f  %10.1f\n", map.name.c_str(), kilobytes,
                       kilobytes / static_cast<double>(run.scansMapped),
                       bytesOf(map) / bytesOf(maps.front()));
    }
    return text +
           "  ours: saved, without compression; others: saved, or by their own account\n";
}

const std::vector<std::string> kOccupancyMaps{"octomap", "ndt-om", "gpoctomap"};

}  // namespace

void ndtStudy(Recording& recording, const Options& options) {
    const bool depthCamera = sensorKindOf(recording.sensor()) == SensorKind::depthCamera;
    const Replayed replayed =
        replayFor(recording, options,
                  depthCamera ? std::vector<std::string>{"ndt:0.05", "ndt:0.1", "ndt:0.15"}
                              : std::vector<std::string>{"ndt:0.2", "ndt:0.4", "ndt:0.6"});
    requireTestPoints(replayed, options);
    std::vector<MapFigures> maps = evaluateBaselines(replayed);
    maps.insert(maps.begin(), evaluateSurfaceOf(replayed));
    conclude(replayed, maps, occupancyTable(replayed.run, maps), options);
}

void occupancyStudy(Recording& recording, const Options& options) {
    const Replayed replayed = replayFor(recording, options, kOccupancyMaps);
    requireTestPoints(replayed, options);
    const std::vector<MapFigures> maps = evaluateReplayed(replayed);
    conclude(replayed, maps, occupancyTable(replayed.run, maps), options);
}

void levelsStudy(Recording& recording, const Options& options) {
    const Replayed replayed = replayFor(recording, options, {});
    requireTestPoints(replayed, options);
    const std::vector<MapFigures> maps = evaluateReplayed(replayed);
    conclude(replayed, maps, levelsTable(maps.front()), options);
}

void memoryStudy(Recording& recording, const Options& options) {
    const Replayed replayed = replayFor(recording, options, kOccupancyMaps);
    const std::vector<MapFigures> maps = evaluateReplayed(replayed);
    conclude(replayed, maps, memoryTable(replayed.run, maps), options);
}

void realtimeStudy(Recording& recording, const Options& options) {
    const Replayed replayed = replayFor(recording, options, {});
    const std::vector<double>& insert_ms = replayed.cost.insert_ms;
    const auto sum = [](const std::vector<double>& values) {
        return std::accumulate(values.begin(), values.end(), 0.0);
    };
    const double conversionMean_ms =
        sum(replayed.conversion_ms) / static_cast<double>(replayed.conversion_ms.size());
    const double insertMean_ms = sum(insert_ms) / static_cast<double>(insert_ms.size());
    const double mean_ms = conversionMean_ms + insertMean_ms;
    const Timing times = summariseTimes(insert_ms);
    std::string found = format("  %d threads, %.0f points a scan\n", replayed.run.threads,
                               replayed.run.pointsPerScan);
    found += format(
        "  %.1f scans/s; a scan takes %.2f ms on average: %.2f conversion, %.2f "
        "insertion\n",
        1000.0 / mean_ms, mean_ms, conversionMean_ms, insertMean_ms);
    found += format("  insertion: median %.2f, p99 %.2f, worst %.2f ms\n", times.median,
                    times.p99, times.worst);
    conclude(replayed, evaluateReplayed(replayed), found, options);
}

}  // namespace replay
