#include "export_command.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <map>
#include <set>
#include <string>
#include <utility>
#include <vector>

namespace maptool {
namespace {

using Formats = std::set<std::string>;
const Formats kFormats = {"ply", "glb", "3Dscene", "png", "bt", "ot", "yaml", "csv", "pgm"};

/// An option that only some formats know.
using Restricted = std::pair<CLI::Option*, Formats>;

std::vector<Restricted> defineSceneOptions(CLI::App& exports,
                                           hgmm::mrpt_bridge::RenderParams& render) {
    const std::map<std::string, int> colours = {
        {"height", 0}, {"weight", 1}, {"occupancy", 2}, {"deviation", 3}, {"modality", 4}};
    CLI::Option* voxels = exports.add_flag(
        "--voxels", render.drawVoxels, "3Dscene: occupied voxels instead of ellipsoids");
    CLI::Option* freeVoxels = exports.add_flag("--free-voxels", "3Dscene: and free voxels");
    freeVoxels->needs(voxels);
    CLI::Option* freeSpace = exports.add_flag("--free-space", render.drawFreeSpace,
                                              "3Dscene: free components as well");
    CLI::Option* colour = exports
                              .add_option("--colour", render.colour,
                                          "3Dscene: what ellipsoids show by colour")
                              ->transform(CLI::Transformer(colours))
                              ->check(CLI::Range(0, 4));
    CLI::Option* modality = exports.add_option(
        "--modality", render.modality,
        "3Dscene: shown with --colour modality; default: rgb, or the first");
    modality->needs(colour);
    return {{voxels, {"3Dscene"}},
            {freeVoxels, {"3Dscene"}},
            {freeSpace, {"3Dscene"}},
            {colour, {"3Dscene"}},
            {modality, {"3Dscene"}}};
}

/// Where the origin of an octree is.
std::vector<Restricted> defineOffset(CLI::App& exports, ExportOptions& exporting) {
    const auto finite = [](const std::string& word) -> std::string {
        double value = 0;
        const bool isNumber =
            CLI::detail::lexical_cast(word, value) && std::isfinite(value);
        return isNumber ? "" : "'" + word + "' must be a finite number";
    };
    CLI::Option* offset =
        exports
            .add_option("--offset", exporting.offset_map,
                        "bt, ot: point of the map that becomes the tree's origin [m], "
                        "rounded to whole cells; written beside the tree")
            ->delimiter(',')
            ->expected(3)
            ->type_name("X,Y,Z")
            ->check(CLI::Validator(finite, ""));
    CLI::Option* local = exports.add_flag("--local", exporting.local,
                                          "bt, ot: --offset with the map's own origin");
    local->excludes(offset);
    return {{offset, {"bt", "ot"}}, {local, {"bt", "ot"}}};
}

/// Where slices are, and what of them is shown.
std::vector<Restricted> defineSlice(CLI::App& exports, ExportOptions& exporting) {
    CLI::Option* height = exports.add_option("--height", exporting.height_m,
                                             "yaml, csv, pgm: height of the slice [m]");
    CLI::Option* band =
        exports
            .add_option("--band", exporting.band_m,
                        "yaml: heights instead [m]: a cell is occupied if anything between "
                        "them is")
            ->delimiter(',')
            ->expected(2)
            ->type_name("LOW,HIGH")
            ->excludes(height);
    CLI::Option* quantity =
        exports
            .add_option("--show", exporting.quantity,
                        "pgm: distance to the nearest surface, or its standard deviation")
            ->check(CLI::IsMember({"distance", "deviation"}))
            ->capture_default_str();
    CLI::Option* farthest = exports
                                .add_option("--max-distance", exporting.maxDistance_m,
                                            "csv, pgm: how far surfaces are looked for [m]")
                                ->check(CLI::Range(1e-3, 1e6))
                                ->capture_default_str();
    CLI::Option* deviation =
        exports
            .add_option("--max-deviation", exporting.maxDeviation_m,
                        "pgm: the standard deviation that is shown brightest [m]")
            ->check(CLI::Range(1e-6, 1e6))
            ->capture_default_str();
    return {{height, {"yaml", "csv", "pgm"}},
            {band, {"yaml"}},
            {quantity, {"pgm"}},
            {farthest, {"csv", "pgm"}},
            {deviation, {"pgm"}}};
}

/// Throws CLI::ParseError for a slice without a height or with a band upside down.
void requireHeight(const ExportOptions& exporting) {
    const bool isSlice = exporting.format == "yaml" || exporting.format == "csv" ||
                         exporting.format == "pgm";
    if (isSlice && !exporting.height_m && exporting.band_m.empty())
        throw CLI::RequiredError("--height");
    if (!exporting.band_m.empty() &&
        !(exporting.band_m[0] < exporting.band_m[1] && std::isfinite(exporting.band_m[1]) &&
          std::isfinite(exporting.band_m[0])))
        throw CLI::ValidationError("--band", "its first height must be below its second");
}

std::vector<Restricted> defineOptions(CLI::App& exports, ExportOptions& exporting) {
    std::vector<Restricted> options = defineSceneOptions(exports, exporting.render);
    for (const auto& option : defineOffset(exports, exporting)) options.push_back(option);
    options.emplace_back(
        exports
            .add_option("--points-per-component", exporting.pointsPerComponent,
                        "ply: so many points of each component instead of its ellipsoid")
            ->check(CLI::PositiveNumber),
        Formats{"ply"});
    options.emplace_back(
        exports
            .add_option("--resolution", exporting.resolution_m,
                        "bt, ot, slices, voxels: edge of a cell [m]; default: from the map")
            ->check(CLI::PositiveNumber),
        Formats{"bt", "ot", "yaml", "csv", "pgm", "3Dscene"});
    for (const auto& option : defineSlice(exports, exporting)) options.push_back(option);
    exports.add_option("--seed", exporting.seed, "ply: seed of the points")
        ->check(CLI::NonNegativeNumber);
    exports.add_option("--yaw", exporting.yaw_deg, "png: viewing direction about z [deg]");
    exports.add_option("--pitch", exporting.pitch_deg, "png: how far it points down [deg]");
    exports.add_option("--cut", exporting.cut,
                       "png: share of the depth, from the viewer on, left out");
    return options;
}

/// The format named, or that of the output's extension.
std::string formatOf(const ExportOptions& exporting) {
    if (!exporting.format.empty()) return exporting.format;
    const std::string extension = std::filesystem::path(exporting.output).extension();
    if (extension.empty() || kFormats.count(extension.substr(1)) == 0)
        throw CLI::ValidationError("OUT", "'" + exporting.output +
                                              "' ends in none of .bt .ot .yaml .csv .pgm "
                                              ".ply .glb .3Dscene .png: say --format");
    return extension.substr(1);
}

}  // namespace

CLI::App* defineExport(CLI::App& app, ExportOptions& exporting) {
    CLI::App* exports = app.add_subcommand("export", "Write the map in another format");
    exports->add_option("MAP", exporting.mapFile, "Saved map")->required();
    exports->add_option("OUT,-o", exporting.output, "Output file")->required();
    exports
        ->add_option(
            "--format", exporting.format,
            "ply: ellipsoids or points; glb: ellipsoids as glTF; 3Dscene: MRPT; png: a "
            "picture; bt, ot: OctoMap; yaml: slice for ROS' map_server; csv, pgm: "
            "slice of distances. Default: OUT's extension")
        ->check(CLI::IsMember(kFormats));
    addForce(*exports, exporting.force);
    exports->add_option("--level", exporting.level, "Level of the hierarchy, 0 = finest")
        ->check(CLI::NonNegativeNumber);
    const std::vector<Restricted> restricted = defineOptions(*exports, exporting);
    exports->callback([&exporting, exports, restricted] {
        exporting.format = formatOf(exporting);
        for (const auto& [option, formats] : restricted)
            if (option->count() > 0 && formats.count(exporting.format) == 0)
                throw CLI::ValidationError(option->get_name(),
                                           "is not for --format " + exporting.format);
        requireHeight(exporting);
        exporting.render.drawEllipsoids = !exporting.render.drawVoxels;
        exporting.render.generateFreeVoxels = exports->count("--free-voxels") > 0;
    });
    return exports;
}

}  // namespace maptool
