#include "prepare_outputs.h"

#include <filesystem>
#include <stdexcept>
#include <vector>

#include "hgmm/mrpt_bridge/output_file.h"
#include "report.h"

namespace fs = std::filesystem;

namespace replay {
namespace {

using hgmm::mrpt_bridge::FileKind;
using hgmm::mrpt_bridge::Output;

/// The files of reports, of studies, too, but for pictures: no input is one.
std::vector<Output> reportOutputs(const std::string& folder) {
    return {{folder + "/metrics.json", FileKind::json},
            {folder + "/room.json", FileKind::json},
            {folder + "/report.html", FileKind::html},
            {folder + "/" + kReportMap, FileKind::map},
            {folder + "/" + kReportPoints, FileKind::ply},
            {folder + "/incremental.csv", FileKind::text},
            {folder + "/landscape.csv", FileKind::text},
            {folder + "/fig3.2.csv", FileKind::text}};
}

}  // namespace

void prepareOutputs(const Options& o) {
    std::vector<std::string> inputs{o.log};
    for (const auto& input : {o.poses, o.config})
        if (input) inputs.push_back(*input);
    if (o.saveMap)
        hgmm::mrpt_bridge::checkOutputs({{*o.saveMap, FileKind::map}}, inputs,
                                        o.force ? hgmm::mrpt_bridge::Replace::anyKind
                                                : hgmm::mrpt_bridge::Replace::sameKind);
    if (!o.reportFolder) return;
    std::error_code error;
    fs::create_directories(*o.reportFolder, error);
    if (!fs::is_directory(*o.reportFolder))
        throw std::runtime_error(*o.reportFolder + ": the report folder cannot be made");
    hgmm::mrpt_bridge::checkOutputs(reportOutputs(*o.reportFolder), inputs);
}

}  // namespace replay
