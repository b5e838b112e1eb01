#include <mrpt/maps/CHGMMOccupancyMap.h>
#include <mrpt/poses/CPose3D.h>

#include <CLI/CLI.hpp>
#include <cstdio>
#include <exception>
#include <string>
#include <vector>

#include "hgmm/evaluation/trajectory.h"
#include "hgmm/mrpt_bridge/observation_to_scan.h"
#include "hgmm/mrpt_bridge/output_file.h"
#include "localiser.h"

namespace {

enum ExitCode { kDone = 0, kBadInput = 1, kWrongUsage = 2 };

struct Options {
    std::string mapFile, log, sensor, trajectory, covariances;
    std::vector<double> start;
    bool print = false, force = false;
};

void define(CLI::App& app, Options& options) {
    app.add_option("MAP", options.mapFile, "Saved map (.hgmm)")->required();
    app.add_option("LOG", options.log, "Recording (.rawlog), or - for scans on stdin")
        ->required();
    app.add_option("--start", options.start,
                   "Where the robot is at the first scan [m, deg]; otherwise the map is "
                   "searched")
        ->delimiter(',')
        ->expected(6)
        ->type_name("X,Y,Z,YAW,PITCH,ROLL");
    app.add_option("--sensor", options.sensor, "Label of the sensor, of several");
    app.add_option("-o,--out", options.trajectory,
                   "Output file: poses of the robot where it is not lost (TUM)");
    app.add_option("--covariances", options.covariances,
                   "Output file: CSV, a row for each scan");
    app.add_flag("--print", options.print, "Print a line for each scan at once");
    app.add_flag("--force", options.force, "Replace output files of another kind");
    app.footer("Exit codes: 0 done, 1 bad input, 2 wrong usage.");
}

std::optional<hgmm::Pose> startOf(const Options& options) {
    const std::vector<double>& s = options.start;
    if (s.empty()) return {};
    for (const double number : s)
        if (!std::isfinite(number)) throw std::runtime_error("--start: must be finite");
    return hgmm::mrpt_bridge::toPose(mrpt::poses::CPose3D(
        s[0], s[1], s[2], mrpt::DEG2RAD(s[3]), mrpt::DEG2RAD(s[4]), mrpt::DEG2RAD(s[5])));
}

std::string covarianceHeader() {
    std::string header = "time_s,lost,overlap,contradicted";
    const char* names[] = {"wx", "wy", "wz", "x", "y", "z"};
    for (int i = 0; i < 6; ++i)
        for (int j = i; j < 6; ++j) header += std::string(",") + names[i] + "_" + names[j];
    return header + "\n";
}

std::string covarianceRow(double time_s, const hgmm::TrackedPose& pose) {
    char text[64];
    std::snprintf(text, sizeof text, "%.6f,%d,%.3f,%.3f", time_s, pose.lost ? 1 : 0,
                  pose.overlap, pose.contradicted);
    std::string row = text;
    for (int i = 0; i < 6; ++i)
        for (int j = i; j < 6; ++j) {
            std::snprintf(text, sizeof text, ",%.9g", pose.covariance(i, j));
            row += text;
        }
    return row + "\n";
}

void print(double time_s, const hgmm::TrackedPose& pose) {
    if (pose.lost) {
        std::printf("%.6f lost\n", time_s);
    } else {
        const std::string line = hgmm::evaluation::tumText({{time_s, pose.T_map_sensor}});
        std::printf("%s overlap %.2f\n", line.substr(0, line.find('\n')).c_str(),
                    pose.overlap);
    }
    std::fflush(stdout);
}

void run(const Options& options) {
    using hgmm::mrpt_bridge::FileKind;
    using hgmm::mrpt_bridge::Replace;
    const bool fromStdin = options.log == "-";
    const Replace replace = options.force ? Replace::anyKind : Replace::sameKind;
    std::vector<std::string> inputs{options.mapFile};
    if (!fromStdin) inputs.push_back(options.log);
    hgmm::mrpt_bridge::checkOutputs(
        {{options.trajectory, FileKind::numbers}, {options.covariances, FileKind::text}},
        inputs, replace);
    mrpt::maps::CHGMMOccupancyMap saved;
    saved.loadFromFile(options.mapFile);
    const auto map = std::make_shared<const hgmm::Map>(saved.model());
    if (map->empty()) throw std::runtime_error(options.mapFile + ": the map is empty");

    localise::Localiser localiser(map, startOf(options));
    const auto source = fromStdin ? localise::openStandardInput()
                                  : localise::openRawlog(options.log, options.sensor);
    hgmm::evaluation::Trajectory trajectory;
    std::string covariances = covarianceHeader();
    std::size_t scans = 0;
    while (const auto timed = source->next()) {
        const hgmm::TrackedPose pose = localiser.next(*timed);
        ++scans;
        if (!pose.lost) trajectory.push_back({timed->time_s, pose.T_map_sensor});
        covariances += covarianceRow(timed->time_s, pose);
        if (options.print) print(timed->time_s, pose);
    }
    const std::string poses = hgmm::evaluation::tumText(trajectory);
    std::vector<hgmm::mrpt_bridge::FileContent> files;
    if (!options.trajectory.empty()) files.push_back({options.trajectory, poses});
    if (!options.covariances.empty()) files.push_back({options.covariances, covariances});
    hgmm::mrpt_bridge::writeFiles(files, replace);
    std::fprintf(stderr, "scans  %zu, %zu lost\n", scans, scans - trajectory.size());
}

}  // namespace

int main(int argc, char** argv) {
    CLI::App app{"Localises a robot in a saved Gaussian mixture map (.hgmm)."};
    Options options;
    define(app, options);
    try {
        app.parse(argc, argv);
    } catch (const CLI::ParseError& e) {
        return app.exit(e) == 0 ? kDone : kWrongUsage;
    }
    try {
        run(options);
    } catch (const std::exception& e) {
        std::fprintf(stderr, "hgmm-localise: %s\n", e.what());
        return kBadInput;
    }
    return kDone;
}
