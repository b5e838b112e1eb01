#include <cstdio>
#include <utility>

#include "commands.h"
#include "hgmm/mrpt_bridge/output_file.h"
#include "load.h"
#include "parse_point.h"
#include "query_answers.h"
#include "query_points.h"

namespace maptool {
namespace {

std::vector<Eigen::Vector3d> pointsOf(const QueryOptions& options) {
    std::vector<Eigen::Vector3d> points;
    for (const std::string& text : options.points)
        points.push_back(parsePoint(text, "'" + text + "'"));
    if (options.pointsFile.empty()) return points;
    const std::vector<Eigen::Vector3d> more = readPoints(options.pointsFile);
    points.insert(points.end(), more.begin(), more.end());
    return points;
}

QueryAnswers ask(const hgmm::Map& map, std::vector<Eigen::Vector3d> points_map,
                 const QueryOptions& options) {
    QueryAnswers answers;
    answers.points_map = std::move(points_map);
    const Eigen::Vector3d* points = answers.points_map.data();
    const std::size_t n = answers.points_map.size();
    answers.occupancy.resize(n);
    map.occupancy(points, n, answers.occupancy.data(), options.level);
    answers.hasDistance = options.distance;
    if (options.distance) {
        hgmm::DistanceParams params;
        params.maxDistance_m = options.maxDistance_m;
        answers.distance.resize(n);
        map.distance(points, n, answers.distance.data(), params, options.level);
    }
    answers.modalityNames = modalitiesOf(map, options.modalities, options.mapFile);
    for (const std::string& name : answers.modalityNames) {
        answers.modalities.emplace_back(n);
        map.modality(name, points, n, answers.modalities.back().data());
    }
    return answers;
}

}  // namespace

void query(const QueryOptions& options) {
    using hgmm::mrpt_bridge::FileKind;
    const bool toFile = !options.output.empty();
    std::vector<std::string> inputs{options.mapFile};
    if (!options.pointsFile.empty()) inputs.push_back(options.pointsFile);
    hgmm::mrpt_bridge::checkOutputs(
        {{options.output, options.json ? FileKind::json : FileKind::text}}, inputs);
    const mrpt::maps::CHGMMOccupancyMap map = loadMap(options.mapFile);
    levelOf(map.model(), options.level, options.mapFile);
    const QueryAnswers answers = ask(map.model(), pointsOf(options), options);
    const std::string text = options.json ? jsonLinesOf(answers)
                             : toFile     ? csvOf(answers)
                                          : listingOf(answers);
    if (toFile)
        hgmm::mrpt_bridge::writeFile(options.output, text);
    else
        std::fwrite(text.data(), 1, text.size(), stdout);
}

void raycast(const RayOptions& options) {
    const Eigen::Vector3d from_map = parsePoint(options.from, "--from");
    const Eigen::Vector3d direction_map = parsePoint(options.direction, "--to-direction");
    const mrpt::maps::CHGMMOccupancyMap map = loadMap(options.mapFile);
    levelOf(map.model(), options.level, options.mapFile);
    hgmm::RayCastParams params;
    params.maxRange_m = options.maxRange_m;
    const auto hit = map.model().castRay(from_map, direction_map, params, options.level);
    if (!hit) {
        std::printf("nothing occupied within %g m\n", options.maxRange_m);
        return;
    }
    std::printf("# x y z, range [m]\n%.9g %.9g %.9g %.4f\n", hit->point_map.x(),
                hit->point_map.y(), hit->point_map.z(), hit->range_m);
}

}  // namespace maptool
