#include "outputs.h"

#include <hgmm/mrpt_bridge/output_file.h>

#include <filesystem>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "earlier.h"
#include "report.h"
#include "simple_map.h"

namespace fs = std::filesystem;

namespace hgmm::slam_app {
namespace {

using mrpt_bridge::FileKind;
using mrpt_bridge::Output;
using mrpt_bridge::OutputFile;
using mrpt_bridge::Replace;

/// In the order in which they are written.
struct Outputs {
    explicit Outputs(const std::string& folder)
        : map{folder + "/map.hgmm", FileKind::map},
          trajectory{folder + "/trajectory.tum", FileKind::numbers},
          graph{folder + "/graph.g2o", FileKind::text},
          keyframes{folder + "/keyframes.simplemap", FileKind::simpleMap},
          report{folder + "/report.svg", FileKind::svg} {}

    std::vector<Output> all() const { return {map, trajectory, graph, keyframes, report}; }

    Output map, trajectory, graph, keyframes, report;
};

Replace replaceBy(const Options& options) {
    return options.force ? Replace::anyKind : Replace::sameKind;
}

void writeText(OutputFile& file, const std::string& text) {
    file.write(text.data(), text.size());
}

}  // namespace

void prepareOutputs(const Options& options) {
    std::error_code error;
    fs::create_directories(options.folder, error);
    if (!fs::is_directory(options.folder))
        throw std::runtime_error(options.folder + ": the folder cannot be made");
    std::vector<std::string> inputs{options.log};
    for (const auto& input : {options.config, options.odometry})
        if (input) inputs.push_back(*input);
    if (options.earlier) inputs.push_back(earlierMapFile(options));
    mrpt_bridge::checkOutputs(Outputs(options.folder).all(), inputs, replaceBy(options));
}

void writeOutputs(const SlamRun& run, mrpt::maps::CHGMMOccupancyMap& map,
                  const evaluation::RecordingOptions& recording, const Options& options) {
    const Outputs outputs(options.folder);
    const Replace replace = replaceBy(options);
    OutputFile trajectoryFile(outputs.trajectory, replace),
        graphFile(outputs.graph, replace), keyframesFile(outputs.keyframes, replace),
        reportFile(outputs.report, replace);
    writeText(trajectoryFile, evaluation::tumText(run.trajectory));
    writeText(graphFile, slam::g2oText(run.slam->graph()));
    mrpt_bridge::writeObject(keyframesFile,
                             SimpleMapOfRecording(options.log, recording, run.trajectory));
    map.model() = run.slam->fusedMap();
    writeText(reportFile, reportSvg(run, std::as_const(map).model(),
                                    fs::path(options.log).filename().string()));
    map.saveToFile(outputs.map.file, options.force);
    OutputFile::commitAll({&trajectoryFile, &graphFile, &keyframesFile, &reportFile});
}

}  // namespace hgmm::slam_app
