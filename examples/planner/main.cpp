#include <mrpt/maps/CHGMMOccupancyMap.h>

#include <CLI/CLI.hpp>
#include <cstdio>
#include <exception>
#include <string>
#include <utility>
#include <vector>

#include "free_space.h"
#include "planning.h"
#include "trials.h"

namespace {

struct Options {
    std::string mapFile, csvFile;
    std::vector<double> from, to;  // [m]
    planner::Robot robot;
    planner::PlanningParams planning;
    bool unknownIsFree = false;
    unsigned seed = 1, random = 0;
    double apart_m = 1.0;
};

void define(CLI::App& app, Options& o) {
    app.add_option("MAP", o.mapFile, "Saved map")->required();
    auto* from = app.add_option("--from", o.from, "Start X,Y,Z in the map [m]");
    auto* to = app.add_option("--to", o.to, "Goal X,Y,Z in the map [m]");
    for (auto* place : {from, to}) place->delimiter(',')->expected(3);
    app.add_option("--radius", o.robot.radius_m, "Of the robot [m]")
        ->required()
        ->check(CLI::PositiveNumber);
    app.add_option("--plane", o.robot.plane_m,
                   "The map is of a planar laser at this height [m]: plan there");
    app.add_option("--margin", o.robot.margin_m,
                   "Kept between robot and surfaces [m]; default: the map's resolution")
        ->check(CLI::NonNegativeNumber);
    app.add_option("--max-probability", o.robot.maxProbability,
                   "More probable collisions block the way")
        ->capture_default_str()
        ->check(CLI::Range(1e-12, 0.5));
    app.add_option("--comfort", o.robot.comfort_m,
                   "Surfaces farther from the centre cost nothing [m]; default: 3 radii")
        ->check(CLI::PositiveNumber);
    app.add_flag("--unknown-is-free", o.unknownIsFree, "Go where nobody has looked, too");
    app.add_option("--step", o.planning.step_m, "Longest edge of the tree [m]")
        ->capture_default_str()
        ->check(CLI::PositiveNumber);
    app.add_option("--max-iterations", o.planning.maxIterations,
                   "There is no path if so many of RRT* do not find one")
        ->capture_default_str()
        ->check(CLI::PositiveNumber);
    app.add_option("--seed", o.seed, "Of the random numbers")->capture_default_str();
    auto* random = app.add_option("--random", o.random,
                                  "So many plans between random places, instead of one");
    app.add_option("--apart", o.apart_m, "Least distance of these places [m]")
        ->capture_default_str()
        ->needs(random)
        ->check(CLI::NonNegativeNumber);
    app.add_option("-o", o.csvFile, "Paths, with columns plan,x,y,z [m]");
    random->excludes(from)->excludes(to);
}

int run(const CLI::App& app, Options& o) {
    mrpt::maps::CHGMMOccupancyMap file;
    file.loadFromFile(o.mapFile);
    const hgmm::Map& map = std::as_const(file).model();
    if (app.count("--margin") == 0) o.robot.margin_m = map.params().filter.resolution_m;
    if (app.count("--comfort") == 0) o.robot.comfort_m = 3 * o.robot.radius_m;
    if (o.unknownIsFree) o.robot.unknown = hgmm::UnknownSpace::free;
    const planner::FreeSpace space(map, o.robot);
    planner::setSeed(o.seed);

    std::vector<planner::Plan> plans;
    if (o.random > 0) {
        plans = planner::randomPlans(space, o.random, o.apart_m, o.planning);
    } else {
        const auto place = [&](const std::vector<double>& x) {
            return Eigen::Vector3d(x[0], x[1], o.robot.plane_m.value_or(x[2]));
        };
        plans = {planner::timedPlan(space, place(o.from), place(o.to), o.planning)};
    }
    planner::printTable(space, plans);
    if (!o.csvFile.empty()) planner::writeCsv(plans, o.csvFile);
    for (const planner::Plan& plan : plans)
        if (plan.path_map.empty()) return 1;
    return 0;
}

}  // namespace

int main(int argc, char** argv) {
    CLI::App app{"Plans the way of a round robot in a saved map"};
    Options options;
    define(app, options);
    try {
        app.parse(argc, argv);
        if (options.random == 0 && (options.from.empty() || options.to.empty()))
            throw CLI::RequiredError("--from and --to, or --random,");
        return run(app, options);
    } catch (const CLI::ParseError& e) {
        return app.exit(e) == 0 ? 0 : 2;
    } catch (const std::exception& e) {
        std::fprintf(stderr, "plan: %s\n", e.what());
        return 1;
    }
}
