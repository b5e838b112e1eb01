#include <cmath>
#include <cstdio>
#include <fstream>
#include <stdexcept>

#include "commands.h"
#include "load.h"
#include "parse_point.h"

namespace maptool {
namespace {

std::vector<Eigen::Vector3d> readPoints(const std::string& file) {
    std::ifstream in(file);
    if (!in) throw std::runtime_error(file + ": cannot be opened");
    std::vector<Eigen::Vector3d> points;
    std::size_t number = 0;
    for (std::string line; std::getline(in, line);) {
        ++number;
        const std::size_t begin = line.find_first_not_of(" \t\r");
        if (begin == std::string::npos || line[begin] == '#') continue;
        points.push_back(parsePoint(line, file + ":" + std::to_string(number)));
    }
    if (in.bad()) throw std::runtime_error(file + ": cannot be read");
    return points;
}

/// By the largest of the three probabilities; unknown where there is a draw.
const char* verdict(const hgmm::Occupancy& answer) {
    if (answer.unknown >= answer.occupied && answer.unknown >= answer.free)
        return "unknown";
    return answer.occupied >= answer.free ? "occupied" : "free";
}

/// Without the end of the line.
void print(const Eigen::Vector3d& p, const hgmm::Occupancy& answer) {
    const char* word = verdict(answer);
    std::printf("%.9g %.9g %.9g %s %.4f %.4f %.4f", p.x(), p.y(), p.z(), word,
                answer.occupied, answer.free, answer.unknown);
    // A distance to a surface that nobody has seen would mean nothing; the variance is 0
    // where no component gives one.
    if (answer.unknown >= 1.F || answer.variance_m2 <= 0.F)
        std::printf(" - -");
    else
        std::printf(" %.4f %.4f", answer.distance_m, std::sqrt(answer.variance_m2));
}

void print(const hgmm::ModalityEstimate& answer) {
    if (answer.known)
        std::printf(" %.6g %.6g", answer.mean, answer.variance);
    else
        std::printf(" - -");
}

/// Answers by modality, then point.
std::vector<std::vector<hgmm::ModalityEstimate>> askModalities(
    const hgmm::Map& map, const std::vector<std::string>& names,
    const std::vector<Eigen::Vector3d>& points) {
    std::vector<std::vector<hgmm::ModalityEstimate>> answers;
    for (const std::string& name : names) {
        answers.emplace_back(points.size());
        map.modality(name, points.data(), points.size(), answers.back().data());
    }
    return answers;
}

void printHeader(const std::vector<std::string>& modalities) {
    std::printf(
        "# x y z [m], answer, P(occupied) P(free) P(unknown), distance to the "
        "surface and its standard deviation [m]");
    for (const std::string& name : modalities)
        std::printf(", %s %s_variance", name.c_str(), name.c_str());
    std::printf("\n");
}

std::vector<Eigen::Vector3d> pointsOf(const QueryOptions& options) {
    std::vector<Eigen::Vector3d> points;
    for (const std::string& text : options.points)
        points.push_back(parsePoint(text, "'" + text + "'"));
    if (options.pointsFile.empty()) return points;
    const std::vector<Eigen::Vector3d> more = readPoints(options.pointsFile);
    points.insert(points.end(), more.begin(), more.end());
    return points;
}

}  // namespace

void query(const QueryOptions& options) {
    const mrpt::maps::CHGMMOccupancyMap map = loadMap(options.mapFile);
    levelOf(map.model(), options.level, options.mapFile);
    const std::vector<std::string> names =
        modalitiesOf(map.model(), options.modalities, options.mapFile);
    const std::vector<Eigen::Vector3d> points = pointsOf(options);
    std::vector<hgmm::Occupancy> answers(points.size());
    map.model().occupancy(points.data(), points.size(), answers.data(), options.level);
    const auto modalities = askModalities(map.model(), names, points);
    printHeader(names);
    for (std::size_t i = 0; i < points.size(); ++i) {
        print(points[i], answers[i]);
        for (const auto& ofModality : modalities) print(ofModality[i]);
        std::printf("\n");
    }
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
