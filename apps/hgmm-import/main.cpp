#include <iostream>

#include "../comma_lists.h"
#include "command_line.h"
#include "import_recording.h"

namespace {

using namespace hgmm::importer;

constexpr int kDone = 0;
constexpr int kBadInput = 1;
constexpr int kWrongUsage = 2;

}  // namespace

int main(int argc, char** argv) {
    CLI::App app(
        "Turns recordings of depth cameras and lidars into MRPT rawlogs, with their poses "
        "as ground truth, and maps of other kinds into Gaussian mixture maps. Exit codes: "
        "0 done, 1 bad input, 2 wrong usage.",
        "hgmm-import");
    app.require_subcommand(1);
    app.set_version_flag("--version", "hgmm-import " HGMM_VERSION);
    Arguments arguments;
    const std::vector<std::pair<std::string, MakeSource>> formats{
        {"tum", addTum(app, arguments)},      {"7scenes", addSevenScenes(app, arguments)},
        {"kitti", addKitti(app, arguments)},  {"pcd", addPcd(app, arguments)},
        {"ply", addPly(app, arguments)},      {"simplemap", addSimpleMap(app, arguments)},
        {"rawlog", addRawlog(app, arguments)}};
    MapImport mapImport;
    addMap(app, mapImport);
    endListsWithTheirArgument(app);
    try {
        app.parse(argc, argv);
    } catch (const CLI::ParseError& e) {
        return app.exit(e) == 0 ? kDone : kWrongUsage;
    }
    if (!arguments.noise.empty())
        arguments.outputs.noise = {arguments.noise[0], arguments.noise[1]};
    if (arguments.force) arguments.outputs.replace = hgmm::mrpt_bridge::Replace::anyKind;
    try {
        if (app.got_subcommand("map")) {
            importMap(mapImport);
            return kDone;
        }
        hgmm::mrpt_bridge::checkOutputs(arguments.outputs.files(),
                                        {arguments.input, arguments.poses},
                                        arguments.outputs.replace);
        for (const auto& [name, makeSource] : formats)
            if (app.got_subcommand(name))
                importRecording(*makeSource(), arguments.outputs, arguments.step);
        return kDone;
    } catch (const std::exception& e) {
        std::cerr << "hgmm-import: " << e.what() << std::endl;
        return kBadInput;
    }
}
