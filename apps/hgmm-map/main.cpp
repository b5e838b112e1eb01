#include <CLI/CLI.hpp>
#include <cstdio>
#include <exception>

#include "../comma_lists.h"
#include "commands.h"
#include "export_command.h"

namespace {

enum ExitCode { kDone = 0, kBadInput = 1, kWrongUsage = 2 };

void addMapAndLevel(CLI::App& command, std::string& mapFile, std::size_t& level) {
    command.add_option("MAP", mapFile, "Saved map")->required();
    command.add_option("--level", level, "Level of the hierarchy, 0 = finest")
        ->check(CLI::NonNegativeNumber);
}

CLI::App* defineSample(CLI::App& app, maptool::SampleOptions& sampling) {
    CLI::App* sample = app.add_subcommand("sample", "Draw points from the map into a .ply");
    addMapAndLevel(*sample, sampling.mapFile, sampling.level);
    sample->add_option("-n", sampling.points, "Number of points")
        ->required()
        ->check(CLI::NonNegativeNumber);
    sample->add_option("--seed", sampling.seed, "Seed of the random numbers")
        ->check(CLI::NonNegativeNumber);
    sample->add_flag("--color,--colour", sampling.colour,
                     "Colour the points: by r, g, b if the map has them, else by its first "
                     "modality");
    sample->add_option("-o", sampling.output, "Output file")->required();
    maptool::addForce(*sample, sampling.force);
    return sample;
}

CLI::App* defineQuery(CLI::App& app, maptool::QueryOptions& querying) {
    CLI::App* query = app.add_subcommand(
        "query", "Ask whether points are occupied, free or unknown, and how surely");
    addMapAndLevel(*query, querying.mapFile, querying.level);
    CLI::Option* points =
        query->add_option("POINT", querying.points, "Points x,y,z [m], in the map frame");
    CLI::Option* file = query->add_option(
        "--points", querying.pointsFile,
        "CSV with columns x, y and z [m], or file with a line x y z for each point");
    query
        ->add_option("--modality", querying.modalities,
                     "Print this modality and its variance too; several: r,intensity")
        ->delimiter(',');
    query->add_flag("--distance", querying.distance,
                    "Answer the distance to the nearest surface, its gradient and standard "
                    "deviation too");
    query
        ->add_option("--max-distance", querying.maxDistance_m,
                     "How far --distance looks [m]")
        ->check(CLI::Range(1e-3, 1e6))
        ->capture_default_str();
    query->add_option("--out", querying.output, "Output file: CSV, or JSON with --json");
    query->add_flag("--json", querying.json, "An object for each point and line");
    query->callback([points, file] {
        if (points->count() + file->count() == 0)
            throw CLI::ValidationError("query", "needs points x,y,z or --points FILE");
    });
    return query;
}

CLI::App* defineRaycast(CLI::App& app, maptool::RayOptions& casting) {
    CLI::App* raycast =
        app.add_subcommand("raycast", "Find the first occupied point along a ray");
    addMapAndLevel(*raycast, casting.mapFile, casting.level);
    raycast->add_option("--from", casting.from, "Start x,y,z [m]")->required();
    raycast->add_option("--to-direction", casting.direction, "Direction x,y,z, any length")
        ->required();
    raycast->add_option("--max-range", casting.maxRange_m, "Where to give up [m]")
        ->check(CLI::PositiveNumber)
        ->capture_default_str();
    return raycast;
}

CLI::App* defineMerge(CLI::App& app, maptool::MergeOptions& merging) {
    CLI::App* merge = app.add_subcommand("merge", "Join two maps into one");
    merge->add_option("A", merging.mapFile, "Saved map; its frame and options stay")
        ->required();
    merge->add_option("B", merging.otherFile, "Saved map to add")->required();
    merge
        ->add_option("--pose", merging.pose,
                     "Where B's frame is in A's [m, deg]; otherwise it is A's")
        ->delimiter(',')
        ->expected(6)
        ->type_name("X,Y,Z,YAW,PITCH,ROLL");
    merge->add_flag("--refine", merging.refine,
                    "Align B's surfaces with A's first; the pose may be half a metre and "
                    "ten degrees off");
    merge->add_option("-o", merging.output, "Output file (.hgmm)")->required();
    maptool::addForce(*merge, merging.force);
    return merge;
}

CLI::App* defineForget(CLI::App& app, maptool::ForgetOptions& forgetting) {
    CLI::App* forget = app.add_subcommand(
        "forget", "Remove the surfaces in a box: what is known to be gone");
    forget->add_option("IN", forgetting.mapFile, "Saved map")->required();
    forget->add_option("OUT", forgetting.output, "Output file (.hgmm)")->required();
    maptool::addForce(*forget, forgetting.force);
    forget
        ->add_option("--box", forgetting.box,
                     "Lowest and highest corner [m], in the map frame")
        ->required()
        ->delimiter(',')
        ->expected(6)
        ->type_name("X0,Y0,Z0,X1,Y1,Z1");
    return forget;
}

CLI::App* defineOptions(CLI::App& app, maptool::OptionsOptions& listing) {
    CLI::App* options = app.add_subcommand(
        "options", "Print the options that a configuration can set, with their defaults");
    CLI::Option* all = options->add_flag("--all", listing.all, "Not only the basic ones");
    options
        ->add_flag("--markdown", listing.markdown,
                   "All, as the page docs/options.md has them")
        ->excludes(all);
    return options;
}

}  // namespace

int main(int argc, char** argv) {
    CLI::App app{"Looks into saved Gaussian mixture maps (.hgmm) and converts them."};
    app.require_subcommand(1);
    app.set_version_flag("--version", "hgmm-map " HGMM_VERSION);
    app.footer("Exit codes: 0 done, 1 bad input, 2 wrong usage.");

    std::string infoFile;
    CLI::App* info =
        app.add_subcommand("info", "Levels, size, extent, origin, modalities and options");
    info->add_option("MAP", infoFile, "Saved map")->required();
    std::vector<std::string> checked;
    CLI::App* check = app.add_subcommand("check", "Say whether maps may go to a robot");
    check->add_option("MAP", checked, "Saved maps")->required();
    maptool::SampleOptions sampling;
    const CLI::App* sample = defineSample(app, sampling);
    maptool::QueryOptions querying;
    const CLI::App* query = defineQuery(app, querying);
    maptool::RayOptions casting;
    const CLI::App* raycast = defineRaycast(app, casting);
    maptool::MergeOptions merging;
    const CLI::App* merge = defineMerge(app, merging);
    maptool::ForgetOptions forgetting;
    const CLI::App* forget = defineForget(app, forgetting);
    maptool::ExportOptions exporting;
    const CLI::App* exports = maptool::defineExport(app, exporting);

    maptool::OptionsOptions listing;
    const CLI::App* options = defineOptions(app, listing);

    endListsWithTheirArgument(app);
    try {
        app.parse(argc, argv);
    } catch (const CLI::ParseError& e) {
        return app.exit(e) == 0 ? kDone : kWrongUsage;
    }
    try {
        if (*info) maptool::info(infoFile);
        if (*check && !maptool::check(checked)) return kBadInput;
        if (*sample) maptool::sample(sampling);
        if (*query) maptool::query(querying);
        if (*raycast) maptool::raycast(casting);
        if (*merge) maptool::merge(merging);
        if (*forget) maptool::forget(forgetting);
        if (*exports) maptool::exportMap(exporting);
        if (*options) maptool::printOptions(listing);
    } catch (const std::exception& e) {
        std::fprintf(stderr, "hgmm-map: %s\n", e.what());
        return kBadInput;
    }
    return kDone;
}
