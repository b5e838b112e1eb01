#include "command_line.h"

namespace hgmm::importer {

void addMap(CLI::App& app, MapImport& import) {
    auto* command = app.add_subcommand(
        "map",
        "Map of another kind, into a map (.hgmm): octree of OctoMap (.bt, .ot), map of "
        "ROS' "
        "map_server (.yaml), or one cloud of a whole place (.pcd, .ply), whose free space "
        "is unknown");
    command->add_option("INPUT", import.input, "Map to read")->required();
    command->add_option("-o", import.output, "Output file (.hgmm)")->required();
    command
        ->add_option("--height", import.height_m,
                     "yaml: height of the layer [m]; otherwise 0")
        ->type_name("M")
        ->check(numbersAbove(-1e6));
    command
        ->add_option("--units-per-metre", import.unitsPerMetre,
                     "pcd, ply: units of coordinates a metre, 1000 for millimetres; "
                     "otherwise 1")
        ->type_name("U")
        ->check(numbersAbove(0));
    command
        ->add_option("--resolution", import.resolution_m,
                     "pcd, ply: resolution_m of the map [m]; otherwise its default")
        ->type_name("M")
        ->check(CLI::Range(0.001, 10.0));
    command->add_flag_callback(
        "--force", [&import] { import.replace = mrpt_bridge::Replace::anyKind; },
        "Replace an existing file of another kind, too");
}

}  // namespace hgmm::importer
