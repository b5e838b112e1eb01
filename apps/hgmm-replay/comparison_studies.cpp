#include "comparison_studies.h"

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

void printHeading(const Run& run, const Options& options) {
    std::printf("study %s: %s, %zu scans mapped, %zu tested%s\n",
                options.study.value_or("").c_str(), run.dataset.c_str(), run.scansMapped,
                run.scansTested, run.interrupted ? " (interrupted)" : "");
}

std::string memoryTable(const Run& run, const std::vector<MapFigures>& maps) {
    std::string text = format("  %-16s  %14s  %14s  %10s\n", "map", "memory [KB]",
                              "per scan [KB]", "times ours");
    const auto bytesOf = [](const MapFigures& map) {
        return static_cast<double>(
            map.memory.serialized_bytes.value_or(map.memory.live_bytes));
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
    std::vector<MapFigures> maps = evaluateReplayed(replayed);
    MapFigures surface = evaluateSurface(replayed.map->model(), replayed.testPoints);
    surface.name = "hgmm surface";
    surface.className = maps.front().className;
    surface.scanTime_ms = maps.front().scanTime_ms;
    maps.front() = std::move(surface);
    printHeading(replayed.run, options);
    std::fputs(occupancyTable(replayed.run, maps).c_str(), stdout);
    if (options.reportFolder)
        writeReport(replayed, maps, *options.reportFolder, picturesOf(replayed));
}

void occupancyStudy(Recording& recording, const Options& options) {
    const Replayed replayed = replayFor(recording, options, kOccupancyMaps);
    requireTestPoints(replayed, options);
    const std::vector<MapFigures> maps = evaluateReplayed(replayed);
    printHeading(replayed.run, options);
    std::fputs(occupancyTable(replayed.run, maps).c_str(), stdout);
    if (options.reportFolder)
        writeReport(replayed, maps, *options.reportFolder, picturesOf(replayed));
}

void levelsStudy(Recording& recording, const Options& options) {
    const Replayed replayed = replayFor(recording, options, {});
    requireTestPoints(replayed, options);
    const std::vector<MapFigures> maps = evaluateReplayed(replayed);
    printHeading(replayed.run, options);
    std::fputs(levelsTable(maps.front()).c_str(), stdout);
    if (options.reportFolder)
        writeReport(replayed, maps, *options.reportFolder, picturesOf(replayed));
}

void memoryStudy(Recording& recording, const Options& options) {
    const Replayed replayed = replayFor(recording, options, kOccupancyMaps);
    const std::vector<MapFigures> maps = evaluateReplayed(replayed);
    printHeading(replayed.run, options);
    std::fputs(memoryTable(replayed.run, maps).c_str(), stdout);
    if (options.reportFolder)
        writeReport(replayed, maps, *options.reportFolder, picturesOf(replayed));
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
    const Timing times = summariseTimes(insert_ms);
    printHeading(replayed.run, options);
    std::printf(
        "  %d threads, %.0f points a scan\n"
        "  %.1f scans/s; a scan takes %.2f ms on average: %.2f conversion, %.2f insertion\n"
        "  insertion: median %.2f, p99 %.2f, worst %.2f ms\n",
        replayed.run.threads, replayed.run.pointsPerScan,
        1000.0 / (conversionMean_ms + insertMean_ms), conversionMean_ms + insertMean_ms,
        conversionMean_ms, insertMean_ms, times.median, times.p99, times.worst);
    if (options.reportFolder)
        writeReport(replayed, evaluateReplayed(replayed), *options.reportFolder,
                    picturesOf(replayed));
}

}  // namespace replay
