#include <CLI/CLI.hpp>
#include <cstdio>
#include <exception>
#include <stdexcept>

#include "../comma_lists.h"
#include "interrupt.h"
#include "map_setup.h"
#include "occupancy_options.h"
#include "options.h"
#include "prepare_outputs.h"
#include "replay_scans.h"
#include "report.h"
#include "studies/studies.h"
#include "table.h"
#include "threads.h"

namespace {

using namespace replay;
using namespace hgmm::evaluation;

enum ExitCode { kDone = 0, kBadInput = 1, kWrongUsage = 2, kInterrupted = 130 };

void defineStudyOptions(CLI::App& app, StudyChoice& choice) {
    app.add_option("--only", choice.only, "Parts of a study to run")->delimiter(',');
    app.add_option("--sensors", choice.sensors, "Simulated sensors of a study")
        ->delimiter(',');
    app.add_option("--after", choice.after, "Scans of a study before what it looks at")
        ->delimiter(',')
        ->check(CLI::Range(1, 1000000));
    app.add_option("--seeds", choice.seeds,
                   "Runs of a simulated study, of which the worst counts")
        ->check(CLI::Range(1, 1000));
}

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
    app.add_option("--report", o.reportFolder, "Folder for metrics.json and figures");
    app.add_option("--save-map", o.saveMap, "File for the map (.hgmm)");
    app.add_flag("--force", o.force, "Replace a file that is no map with --save-map, too");
    app.add_option("--from", o.from, "First scan to use")->check(CLI::NonNegativeNumber);
    app.add_option("--to", o.to, "Last scan to use")->check(CLI::NonNegativeNumber);
    app.add_option("--threads", o.threads, "Threads (0 = one per core)")
        ->check(CLI::Range(0, 1024));
    app.add_option("--seed", o.split.seed, "Seed of all random choices")
        ->check(CLI::NonNegativeNumber);
    app.add_flag("--quiet", o.quiet, "No progress");
    app.add_option("--study", o.study, "Make a study instead of a map (--list-studies)")
        ->check([](const std::string& name) {
            return findStudy(name) ? "" : "no such study; --list-studies names them";
        });
    app.add_flag("--list-studies", listStudies, "List the studies");
    defineStudyOptions(app, o.choice);
}

void checkStudyUsage(const Study& study, const Options& o) {
    using Needs = Study::Needs;
    const std::string option = "--study " + study.name;
    if (study.needs == Needs::nothing && !o.log.empty())
        throw CLI::ValidationError(option, "makes its own data and takes no LOG");
    if (study.needs == Needs::testPoints && o.split.every == 0 &&
        o.split.holdoutPoints == 0.0)
        throw CLI::ValidationError(option,
                                   "needs test points: --split K or --holdout-points F");
    if (study.needs == Needs::testScans && o.split.every == 0)
        throw CLI::ValidationError(option, "needs test scans: --split K");
}

void checkUsage(const Options& o) {
    const Study* study = o.study ? findStudy(*o.study) : nullptr;
    if (study) checkStudyUsage(*study, o);
    if (o.log.empty() && (!study || study->needs != Study::Needs::nothing))
        throw CLI::RequiredError("LOG");
    checkOccupancyUsage(o);
    if (o.from > o.to) throw CLI::ValidationError("--from", "lies beyond --to");
    try {
        o.split.validate();
    } catch (const std::invalid_argument& e) {
        throw CLI::ValidationError(e.what());
    }
}

/// Says which modalities the map was to have and no scan brought.
void warnOfAbsentModalities(const hgmm::Map& map) {
    for (const std::string& name : map.modalities())
        if (const hgmm::ModalityMap* found = map.modality(name);
            !found || found->size() == 0)
            std::fprintf(stderr, "warning: modalities: no scan had a channel %s\n",
                         name.c_str());
}

ExitCode makeMapAndReport(Recording& recording, const Options& options) {
    const Replayed replayed = replayScans(recording, makeMap(options.config), options);
    if (replayed.run.scansMapped == 0)
        throw std::runtime_error(options.log + ": no scan was left to build a map from");
    warnOfAbsentModalities(std::as_const(*replayed.map).model());
    const std::vector<MapFigures> maps = evaluateReplayed(replayed);
    std::fputs(table(replayed.run, maps, summariseTimes(replayed.conversion_ms)).c_str(),
               stdout);
    if (options.reportFolder)
        writeReport(replayed, maps, *options.reportFolder, picturesOf(replayed));
    if (options.saveMap) replayed.map->saveToFile(*options.saveMap, options.force);
    if (!replayed.run.interrupted) return kDone;
    std::fprintf(stderr,
                 "interrupted: all of the above is for the first %zu of %zu scans\n",
                 replayed.run.scansMapped + replayed.run.scansTested, recording.size());
    return kInterrupted;
}

ExitCode run(Options& options) {
    checkBaselines(options);
    prepareOutputs(options);
    options.threads = useThreads(options.threads);
    const Study* study = options.study ? findStudy(*options.study) : nullptr;
    if (study && study->needs == Study::Needs::nothing) {
        study->alone(options);
        return interrupted() ? kInterrupted : kDone;
    }
    const bool posesRequired = !study || study->needs != Study::Needs::scans;
    RecordingOptions recordingOptions{options.poses, options.from, options.to,
                                      posesRequired};
    Recording recording(options.log, recordingOptions);
    if (!recording.damage().empty())
        std::fprintf(stderr, "warning: %s\n", recording.damage().c_str());
    catchInterrupts();
    if (!study) return makeMapAndReport(recording, options);
    study->run(recording, recordingOptions, options);
    return interrupted() ? kInterrupted : kDone;
}

}  // namespace

int main(int argc, char** argv) {
    CLI::App app{
        "Replays a recording into a hierarchical Gaussian mixture map and evaluates it."};
    app.set_version_flag("--version", "hgmm-replay " HGMM_VERSION);
    Options options;
    bool listStudies = false;
    app.footer("Exit codes: 0 done, 1 bad input, 2 wrong usage, 130 interrupted.");
    defineOptions(app, options, listStudies);
    endListsWithTheirArgument(app);
    try {
        app.parse(argc, argv);
        if (listStudies) {
            std::fputs(studyList().c_str(), stdout);
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
