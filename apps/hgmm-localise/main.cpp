#include <mrpt/maps/CHGMMOccupancyMap.h>
#include <mrpt/poses/CPose3D.h>

#include <CLI/CLI.hpp>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <exception>
#include <memory>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "../comma_lists.h"
#include "hgmm/evaluation/timing.h"
#include "hgmm/mrpt_bridge/observation_to_scan.h"
#include "interrupt.h"
#include "localiser.h"
#include "options.h"
#include "pose_outputs.h"
#include "threads.h"

namespace {

using namespace localise;
using Clock = std::chrono::steady_clock;

enum ExitCode { kDone = 0, kBadInput = 1, kWrongUsage = 2, kInterrupted = 130 };

void defineOptions(CLI::App& app, Options& o) {
    app.add_option("MAP", o.mapFile, "Saved map (.hgmm)")->required();
    app.add_option("LOG", o.log, "Recording (.rawlog), or - for scans on stdin")
        ->required();
    app.add_option("--start", o.start,
                   "About where the robot is at the first scan [m, deg]; otherwise the "
                   "map is searched")
        ->delimiter(',')
        ->expected(6)
        ->type_name("X,Y,Z,YAW,PITCH,ROLL");
    app.add_option("--sensor", o.sensorLabel, "Label of the sensor whose scans are used");
    app.add_option("-o,--output", o.trajectory,
                   "File for the robot's poses where it is not lost (TUM lines)");
    app.add_option("--csv", o.table, "File for the rows of stdout (.csv)");
    app.add_option("--threads", o.threads, "Threads (0 = one per core)")
        ->check(CLI::Range(0, 1024));
    app.add_flag("--force", o.force, "Replace files of other kinds, too");
    app.add_flag("--quiet", o.quiet, "No rows on stdout");
}

std::optional<hgmm::Pose> startOf(const Options& options) {
    const std::vector<double>& s = options.start;
    if (s.empty()) return {};
    for (const double number : s)
        if (!std::isfinite(number))
            throw std::runtime_error("--start: a number is not finite");
    return hgmm::mrpt_bridge::toPose(mrpt::poses::CPose3D(
        s[0], s[1], s[2], mrpt::DEG2RAD(s[3]), mrpt::DEG2RAD(s[4]), mrpt::DEG2RAD(s[5])));
}

std::shared_ptr<const hgmm::Map> loadMap(const std::string& file) {
    mrpt::maps::CHGMMOccupancyMap map;
    map.loadFromFile(file);
    if (std::as_const(map).model().empty())
        throw std::runtime_error(file + ": the map is empty");
    return std::make_shared<const hgmm::Map>(std::as_const(map).model());
}

struct Tally {
    std::size_t lost = 0;
    std::vector<double> durations_ms;  ///< of each scan, reading excluded

    void print() const {
        const hgmm::evaluation::Timing times =
            hgmm::evaluation::summariseTimes(durations_ms);
        std::fprintf(stderr, "%zu scans, %zu lost; %.1f ms a scan (median), %.1f (worst)\n",
                     durations_ms.size(), lost, times.median, times.worst);
    }
};

void localiseAll(ScanSource& source, Localiser& localiser, PoseOutputs& outputs,
                 Tally& tally) {
    while (const auto timed = source.next()) {
        const Clock::time_point begin = Clock::now();
        const auto pose = localiser.next(*timed);
        tally.durations_ms.push_back(
            std::chrono::duration<double, std::milli>(Clock::now() - begin).count());
        if (!pose || pose->lost) ++tally.lost;
        outputs.add(timed->time_s, pose);
    }
}

ExitCode run(const Options& options) {
    const auto start = startOf(options);
    PoseOutputs outputs(options);
    replay::useThreads(options.threads);
    Localiser localiser(loadMap(options.mapFile), start);
    const auto source = options.readsStdin() ? openStandardInput()
                                             : openRawlog(options.log, options.sensorLabel);
    replay::catchInterrupts();
    Tally tally;
    try {
        localiseAll(*source, localiser, outputs, tally);
    } catch (const std::exception&) {
        // What was found before the input went bad is good.
        if (!tally.durations_ms.empty()) outputs.commit();
        throw;
    }
    outputs.commit();
    tally.print();
    if (!replay::interrupted()) return kDone;
    std::fprintf(stderr, "interrupted after %zu scans\n", tally.durations_ms.size());
    return kInterrupted;
}

}  // namespace

int main(int argc, char** argv) {
    CLI::App app{"Follows a robot in a saved map, scan by scan."};
    Options options;
    app.set_version_flag("--version", "hgmm-localise " HGMM_VERSION);
    app.footer("Exit codes: 0 done, 1 bad input, 2 wrong usage, 130 interrupted.");
    defineOptions(app, options);
    endListsWithTheirArgument(app);
    try {
        app.parse(argc, argv);
    } catch (const CLI::ParseError& e) {
        return app.exit(e) == 0 ? kDone : kWrongUsage;
    }
    try {
        return run(options);
    } catch (const std::exception& e) {
        std::fprintf(stderr, "hgmm-localise: %s\n", e.what());
        return kBadInput;
    }
}
