#include <sys/resource.h>

#include <CLI/CLI.hpp>
#include <cstdio>
#include <exception>
#include <stdexcept>

#include "checkpoint.h"
#include "earlier.h"
#include "interrupt.h"
#include "map_setup.h"
#include "options.h"
#include "outputs.h"
#include "run_slam.h"
#include "threads.h"

namespace {

using namespace hgmm::slam_app;
using hgmm::evaluation::Recording;

enum ExitCode { kDone = 0, kBadInput = 1, kWrongUsage = 2, kInterrupted = 130 };

void defineOptions(CLI::App& app, Options& o) {
    app.add_option("LOG", o.log, "Recording (.rawlog)")->required();
    app.add_option("-o,--output", o.folder, "Folder for the map and all else")->required();
    app.add_option("--sensor", o.sensorLabel, "Label of the sensor whose scans are used");
    app.add_option("--odometry", o.odometry,
                   "Poses of the robot by other means, which may drift; TUM lines");
    app.add_flag("--ignore-odometry", o.ignoreOdometry, "Use no odometry of the recording");
    CLI::Option* const config = app.add_option(
        "--config", o.config, "Map options: an MRPT .ini with hgmmMap_count = 1");
    app.add_option("--continue", o.earlier,
                   "Map of an earlier session to go on from (.hgmm), or its folder; its "
                   "options are those of the new map")
        ->excludes(config);
    app.add_option("--from", o.from, "First scan to use")->check(CLI::NonNegativeNumber);
    app.add_option("--to", o.to, "Last scan to use")->check(CLI::NonNegativeNumber);
    app.add_option("--save-every", o.saveEvery_s,
                   "Seconds between states from which an interrupted run goes on")
        ->check(CLI::NonNegativeNumber);
    app.add_flag("--restart", o.restart,
                 "Begin anew where FOLDER holds a run that was not finished");
    app.add_option("--threads", o.threads, "Threads (0 = one per core)")
        ->check(CLI::Range(0, 1024));
    app.add_flag("--force", o.force, "Replace files of other kinds, too");
    app.add_flag("--quiet", o.quiet, "No progress");
}

void printSummary(const SlamRun& run, const Options& options) {
    const std::size_t scans = run.trajectory.size();
    rusage used{};
    getrusage(RUSAGE_SELF, &used);
    std::printf(
        "%zu scans in %.1f s (%.1f scans/s), %zu submaps, %zu loop closures, %ld MB\n",
        scans, run.seconds, static_cast<double>(scans) / run.seconds, run.slam->submaps(),
        run.slam->closures(), used.ru_maxrss / 1024);
    if (run.continuation.found)
        std::printf("goes on from %s: %zu of %zu submaps that were looked for agree\n",
                    earlierMapFile(options).c_str(), run.continuation.agreeing,
                    run.continuation.searched);
    if (run.scansLost > 0)
        std::printf("warning: %zu scans were not recognised; their poses are guesses\n",
                    run.scansLost);
    if (run.slam->parts() > 1)
        std::printf(
            "warning: the map has %zu parts, and how they lie to each other is a guess\n",
            run.slam->parts());
}

ExitCode run(Options& options) {
    prepareOutputs(options);
    replay::useThreads(options.threads);
    const auto map =
        options.earlier ? loadEarlier(options) : replay::makeMap(options.config);
    const hgmm::evaluation::RecordingOptions recordingOptions =
        recordingOptionsFor(options);
    Recording recording(options.log, recordingOptions);
    if (!recording.damage().empty())
        std::fprintf(stderr, "warning: %s\n", recording.damage().c_str());
    Checkpoint checkpoint(options, *map, recordingOptions.sensorLabel);
    if (options.restart) checkpoint.remove();
    replay::catchInterrupts();
    SlamRun slam = runSlam(recording, map->insertionOptions.params,
                           map->insertionOptions.reading, options, checkpoint);
    if (options.earlier) goOnFrom(*map, slam, options);
    const bool isLost = options.earlier && !slam.continuation.found;
    if (!isLost) writeOutputs(slam, *map, recordingOptions, options);
    if (!slam.interrupted) checkpoint.remove();
    if (isLost && !slam.interrupted)
        throw std::runtime_error(notFound(slam.continuation, options));
    if (!isLost) printSummary(slam, options);
    if (!slam.interrupted) return kDone;
    std::fprintf(stderr, "interrupted after %zu of %zu scans%s%s\n", slam.trajectory.size(),
                 recording.size(),
                 isLost ? ", not found in the earlier map so far: no map was written" : "",
                 slam.canGoOn ? "; the same command goes on from there" : "");
    return kInterrupted;
}

}  // namespace

int main(int argc, char** argv) {
    CLI::App app{
        "Simultaneous localisation and mapping: one consistent map from a recording."};
    Options options;
    app.set_version_flag("--version", "hgmm-slam " HGMM_VERSION);
    app.footer("Exit codes: 0 done, 1 bad input, 2 wrong usage, 130 interrupted.");
    defineOptions(app, options);
    try {
        app.parse(argc, argv);
    } catch (const CLI::ParseError& e) {
        return app.exit(e) == 0 ? kDone : kWrongUsage;
    }
    try {
        return run(options);
    } catch (const std::exception& e) {
        std::fprintf(stderr, "hgmm-slam: %s\n", e.what());
        return kBadInput;
    }
}
