#include <CLI/CLI.hpp>
#include <cstdio>
#include <exception>
#include <filesystem>
#include <stdexcept>

#include "fidelity_study.h"
#include "free_space_study.h"
#include "incremental_study.h"
#include "interrupt.h"
#include "map_setup.h"
#include "occupancy_options.h"
#include "options.h"
#include "regression_study.h"
#include "replay_scans.h"
#include "report.h"
#include "room_study.h"
#include "table.h"
#include "threads.h"

namespace {

using namespace replay;
using namespace hgmm::evaluation;

enum ExitCode { kDone = 0, kBadInput = 1, kWrongUsage = 2, kInterrupted = 130 };

constexpr const char* kStudies =
    "fig3.2       estimated size of each scan's mixture, and its divergence as it is "
    "reduced\n"
    "incremental  held-out likelihood of the map against mixtures of as many components\n"
    "             fitted to all scans at once; needs --split K or --holdout-points F\n"
    "free-space   both models of free space side by side; needs test points as above.\n"
    "             The thesis' own is slow on large maps: begin with --to 50\n"
    "room         shares of right answers in a noiseless box room; needs --split K. Add\n"
    "             noise with --range-noise S\n"
    "fig4.5       variance of a noisy sine, by mixture and by Gaussian process; no LOG\n";

void defineOptions(CLI::App& app, Options& o, bool& listStudies) {
    app.add_option("LOG", o.log, "Recording to replay (.rawlog)");
    app.add_option("--config", o.config,
                   "Map options: an MRPT .ini with hgmmMap_count = 1");
    app.add_option("--poses", o.poses,
                   "Poses of the robot, TUM lines: t x y z qx qy qz qw");
    app.add_option(
        "--split", o.split.every,
        "Scans i with i % K == K/2 test the map instead of building it (0 = none)");
    app.add_option("--subsample", o.split.subsample,
                   "Fraction of the points of each mapping scan that is used");
    app.add_option(
        "--holdout-points", o.split.holdoutPoints,
        "Fraction of the points of each mapping scan that tests the map instead");
    app.add_option("--range-noise", o.rangeNoise_m,
                   "Gaussian noise added to the ranges of mapping scans, one sigma (m)")
        ->check(CLI::Range(0.0, 10.0));
    defineOccupancyOptions(app, o);
    app.add_option("--report,--out", o.reportFolder, "Folder for metrics.json and figures");
    app.add_option("--save-map", o.saveMap, "File for the map (.hgmm)");
    app.add_option("--from", o.from, "First scan to use")->check(CLI::NonNegativeNumber);
    app.add_option("--to", o.to, "Last scan to use")->check(CLI::NonNegativeNumber);
    app.add_option("--threads", o.threads, "Threads (0 = one per core)")
        ->check(CLI::Range(0, 1024));
    app.add_option("--seed", o.split.seed, "Seed of all random choices")
        ->check(CLI::NonNegativeNumber);
    app.add_flag("--quiet", o.quiet, "No progress");
    app.add_option("--study", o.study, "Make a study instead of a map (--list-studies)")
        ->check(CLI::IsMember({"fig3.2", "incremental", "free-space", "room", "fig4.5"}));
    app.add_flag("--list-studies", listStudies, "List the studies");
}

void checkUsage(const Options& o) {
    if (o.study == "fig4.5" && !o.log.empty())
        throw CLI::ValidationError("--study fig4.5", "makes its own data and takes no LOG");
    if (o.log.empty() && o.study != "fig4.5") throw CLI::RequiredError("LOG");
    checkOccupancyUsage(o);
    if (o.from > o.to) throw CLI::ValidationError("--from", "lies beyond --to");
    const bool comparesMaps = o.study == "incremental" || o.study == "free-space";
    if (comparesMaps && o.split.every == 0 && o.split.holdoutPoints == 0.0)
        throw CLI::ValidationError("--study " + *o.study,
                                   "needs test points: --split K or --holdout-points F");
    if (o.study == "room" && o.split.every == 0)
        throw CLI::ValidationError("--study room", "needs test scans: --split K");
    try {
        o.split.validate();
    } catch (const std::invalid_argument& e) {
        throw CLI::ValidationError(e.what());
    }
}

/// Files that could not be written at the end of a long run had better be known at its
/// start.
void prepareOutputs(const Options& o) {
    std::error_code error;
    if (o.reportFolder) std::filesystem::create_directories(*o.reportFolder, error);
    if (o.reportFolder && !std::filesystem::is_directory(*o.reportFolder))
        throw std::runtime_error(*o.reportFolder + ": the report folder cannot be made");
    const auto folder = std::filesystem::path(o.saveMap.value_or("")).parent_path();
    if (!folder.empty() && !std::filesystem::is_directory(folder))
        throw std::runtime_error(*o.saveMap + ": there is no folder " + folder.string());
}

ExitCode makeMapAndReport(Recording& recording, const Options& options) {
    const Replayed replayed = replayScans(recording, makeMap(options.config), options);
    if (replayed.run.scansMapped == 0)
        throw std::runtime_error(options.log + ": no scan was left to build a map from");
    const std::vector<MapFigures> maps = evaluateReplayed(replayed);
    std::fputs(table(replayed.run, maps, summariseTimes(replayed.conversion_ms)).c_str(),
               stdout);
    if (options.reportFolder) writeReport(replayed.run, maps, *options.reportFolder);
    if (options.saveMap) replayed.map->saveToFile(*options.saveMap);
    if (!replayed.run.interrupted) return kDone;
    std::fprintf(stderr,
                 "interrupted: all of the above is for the first %zu of %zu scans\n",
                 replayed.run.scansMapped + replayed.run.scansTested, recording.size());
    return kInterrupted;
}

ExitCode run(Options& options) {
    prepareOutputs(options);
    options.threads = useThreads(options.threads);
    if (options.study == "fig4.5") {
        regressionStudy(options);
        return kDone;
    }
    RecordingOptions recordingOptions{options.poses, options.from, options.to,
                                      options.study != "fig3.2"};
    Recording recording(options.log, recordingOptions);
    if (!recording.damage().empty())
        std::fprintf(stderr, "warning: %s\n", recording.damage().c_str());
    catchInterrupts();
    if (!options.study) return makeMapAndReport(recording, options);
    if (options.study == "incremental")
        incrementalStudy(recording, recordingOptions, options);
    else if (options.study == "free-space")
        freeSpaceStudy(recording, recordingOptions, options);
    else if (options.study == "room")
        roomStudy(recording, recordingOptions, options);
    else
        fidelityStudy(recording, makeMap(options.config)->insertionOptions.params, options);
    return interrupted() ? kInterrupted : kDone;
}

}  // namespace

int main(int argc, char** argv) {
    CLI::App app{
        "Replays a recording into a hierarchical Gaussian mixture map and evaluates it."};
    Options options;
    bool listStudies = false;
    app.footer("Exit codes: 0 done, 1 bad input, 2 wrong usage, 130 interrupted.");
    defineOptions(app, options, listStudies);
    try {
        app.parse(argc, argv);
        if (listStudies) {
            std::fputs(kStudies, stdout);
            return kDone;
        }
        checkUsage(options);
    } catch (const CLI::ParseError& e) {
        return app.exit(e) == 0 ? kDone : kWrongUsage;
    }
    try {
        return run(options);
    } catch (const std::exception& e) {
        std::fprintf(stderr, "hgmm-replay: %s\n", e.what());
        return kBadInput;
    }
}
