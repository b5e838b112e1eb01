#include <algorithm>
#include <iostream>

#include "command_line.h"
#include "import_recording.h"

namespace {

using namespace hgmm::importer;

constexpr int kDone = 0;
constexpr int kBadInput = 1;
constexpr int kWrongUsage = 2;

/// Throws CLI::ValidationError if two outputs would overwrite each other.
void requireDistinct(const RecordingOutputs& outputs) {
    const std::vector<std::string> names{outputs.rawlog, outputs.poses, outputs.simplemap,
                                         outputs.cloud};
    for (std::size_t i = 0; i < names.size(); ++i)
        if (!names[i].empty() && std::count(names.begin(), names.end(), names[i]) > 1)
            throw CLI::ValidationError("output", "two outputs have the same name");
}

}  // namespace

int main(int argc, char** argv) {
    CLI::App app(
        "Turns recordings of depth cameras and lidars into MRPT rawlogs, with their poses "
        "as ground truth. Exit codes: 0 done, 1 bad input, 2 wrong usage.",
        "hgmm-import");
    app.require_subcommand(1);
    Arguments arguments;
    const std::vector<std::pair<std::string, MakeSource>> formats{
        {"tum", addTum(app, arguments)},      {"7scenes", addSevenScenes(app, arguments)},
        {"kitti", addKitti(app, arguments)},  {"pcd", addPcd(app, arguments)},
        {"ply", addPly(app, arguments)},      {"simplemap", addSimpleMap(app, arguments)},
        {"rawlog", addRawlog(app, arguments)}};
    try {
        app.parse(argc, argv);
        requireDistinct(arguments.outputs);
    } catch (const CLI::ParseError& e) {
        return app.exit(e) == 0 ? kDone : kWrongUsage;
    }
    if (!arguments.noise.empty())
        arguments.outputs.noise = {arguments.noise[0], arguments.noise[1]};
    try {
        for (const auto& [name, makeSource] : formats)
            if (app.got_subcommand(name))
                importRecording(*makeSource(), arguments.outputs, arguments.step);
        return kDone;
    } catch (const std::exception& e) {
        std::cerr << "hgmm-import: " << e.what() << std::endl;
        return kBadInput;
    }
}
