#include <CLI/CLI.hpp>
#include <cstdio>
#include <exception>

#include "commands.h"

namespace {

enum ExitCode { kDone = 0, kBadInput = 1, kWrongUsage = 2 };

CLI::App* defineExport(CLI::App& app, maptool::ExportOptions& exporting) {
    CLI::App* exports = app.add_subcommand("export", "Write the map in another format");
    exports->add_option("MAP", exporting.mapFile, "Saved map")->required();
    exports
        ->add_option("--format", exporting.format,
                     "ply: ellipsoids or points; 3Dscene: MRPT; png: a picture")
        ->required()
        ->check(CLI::IsMember({"ply", "3Dscene", "png"}));
    exports->add_option("--level", exporting.level, "Level of the hierarchy, 0 = finest")
        ->check(CLI::NonNegativeNumber);
    auto* points = exports->add_option(
        "--points-per-component", exporting.pointsPerComponent,
        "ply: so many points of each component instead of its ellipsoid");
    points->check(CLI::PositiveNumber);
    exports->add_option("--seed", exporting.seed, "Seed of the points")
        ->check(CLI::NonNegativeNumber);
    exports->add_option("--yaw", exporting.view.yaw_deg,
                        "png: viewing direction about z [deg]");
    exports->add_option("--pitch", exporting.view.pitch_deg,
                        "png: how far it points down [deg]");
    exports->add_option("--cut", exporting.view.cut,
                        "png: share of the depth, from the viewer on, left out");
    exports->add_option("-o", exporting.output, "Output file")->required();
    exports->callback([&exporting, points] {
        if (exporting.format != "ply" && points->count() > 0)
            throw CLI::ValidationError("--points-per-component",
                                       "is for --format ply only");
    });
    return exports;
}

}  // namespace

int main(int argc, char** argv) {
    CLI::App app{"Looks into saved Gaussian mixture maps (.hgmm) and converts them."};
    app.require_subcommand(1);
    app.footer("Exit codes: 0 done, 1 bad input, 2 wrong usage.");

    std::string infoFile;
    CLI::App* info = app.add_subcommand("info", "Levels, size, extent, origin and options");
    info->add_option("MAP", infoFile, "Saved map")->required();

    maptool::SampleOptions sampling;
    CLI::App* sample = app.add_subcommand("sample", "Draw points from the map into a .ply");
    sample->add_option("MAP", sampling.mapFile, "Saved map")->required();
    sample->add_option("-n", sampling.points, "Number of points")
        ->required()
        ->check(CLI::NonNegativeNumber);
    sample->add_option("--seed", sampling.seed, "Seed of the random numbers")
        ->check(CLI::NonNegativeNumber);
    sample->add_option("--level", sampling.level, "Level of the hierarchy, 0 = finest")
        ->check(CLI::NonNegativeNumber);
    sample->add_option("-o", sampling.output, "Output file")->required();

    maptool::ExportOptions exporting;
    CLI::App* exports = defineExport(app, exporting);

    try {
        app.parse(argc, argv);
    } catch (const CLI::ParseError& e) {
        return app.exit(e) == 0 ? kDone : kWrongUsage;
    }
    try {
        if (*info) maptool::info(infoFile);
        if (*sample) maptool::sample(sampling);
        if (*exports) maptool::exportMap(exporting);
    } catch (const std::exception& e) {
        std::fprintf(stderr, "hgmm-map: %s\n", e.what());
        return kBadInput;
    }
    return kDone;
}
