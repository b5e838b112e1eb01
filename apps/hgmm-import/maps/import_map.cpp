#include "maps/import_map.h"

#include <mrpt/maps/CHGMMOccupancyMap.h>

#include <cstdio>
#include <filesystem>
#include <iostream>
#include <stdexcept>

#include "files.h"
#include "maps/octree_file.h"
#include "maps/ros_map.h"
#include "pcd_reader.h"
#include "ply_reader.h"

namespace hgmm::importer {
namespace {

/// Extents of buildings and outdoor maps; others are doubted [m].
constexpr double kUsualLeast_m = 0.5, kUsualMost_m = 20000;

void note(const std::string& text) {
    std::cerr << "note: " << text << "\n";
}

std::size_t countOf(const std::vector<CellCube>& cubes) {
    std::size_t cells = 0;
    for (const CellCube& cube : cubes)
        cells += static_cast<std::size_t>(cube.size) * cube.size * cube.size;
    return cells;
}

/// A map, and what to say of it.
struct Imported {
    Map map;
    std::string summary;
};

Imported fromCells(const KnownCells& cells, const std::string& file) {
    if (cells.occupied.empty() && cells.free.empty())
        failFile(file, "knows nothing: no cell is occupied or free");
    char text[200];
    std::snprintf(text, sizeof text,
                  "%zu occupied and %zu free cells of %g m; all else is unknown",
                  countOf(cells.occupied), countOf(cells.free), cells.edge_m);
    try {
        return {Map::fromCells(cells), text};
    } catch (const std::invalid_argument& e) {
        failFile(file, e.what());
    }
}

Imported fromRosMap(const MapImport& import) {
    const double height_m = import.height_m.value_or(0);
    const RosMap map = readRosMap(import.input, height_m);
    for (const std::string& text : map.notes) note(text);
    Imported imported = fromCells(map.cells, import.input);
    char text[80];
    std::snprintf(text, sizeof text, "; the layer is at z = %g m%s", height_m,
                  import.height_m ? "" : " (--height)");
    imported.summary += text;
    return imported;
}

std::string listed(const std::vector<std::string>& names) {
    std::string text;
    for (const std::string& name : names) text += (text.empty() ? "" : " ") + name;
    return text;
}

/// Points in metres, without those that stand for no return.
std::vector<Eigen::Vector3d> pointsOf(const RecordedCloud& cloud, double unitsPerMetre) {
    std::vector<Eigen::Vector3d> points_map;
    points_map.reserve(cloud.points.size());
    for (const RecordedPoint& point : cloud.points)
        if (point.position.allFinite() && !point.position.isZero())
            points_map.push_back(point.position / unitsPerMetre);
    return points_map;
}

void doubtExtent(const std::vector<Eigen::Vector3d>& points_map, const MapImport& import) {
    Eigen::AlignedBox3d box;
    for (const Eigen::Vector3d& p : points_map) box.extend(p);
    const double extent_m = box.sizes().maxCoeff();
    if (import.unitsPerMetre || (extent_m > kUsualLeast_m && extent_m < kUsualMost_m))
        return;
    char text[200];
    std::snprintf(text, sizeof text,
                  "points span %.3g m: check their unit, and give --units-per-metre (1000 "
                  "for millimetres, 1 if they are metres)",
                  extent_m);
    note(text);
}

Imported fromCloud(const MapImport& import, const RecordedCloud& cloud) {
    const std::vector<Eigen::Vector3d> points_map =
        pointsOf(cloud, import.unitsPerMetre.value_or(1));
    if (points_map.empty()) failFile(import.input, "holds no point that is finite");
    doubtExtent(points_map, import);
    MapParams params;
    if (import.resolution_m) params.setResolution(*import.resolution_m);
    std::vector<std::string> left = cloud.unused;
    for (const auto* fields : {&cloud.intensityFields, &cloud.colorFields})
        left.insert(left.end(), fields->begin(), fields->end());
    std::string summary =
        std::to_string(points_map.size()) + " points, " +
        std::to_string(cloud.points.size() - points_map.size()) +
        " dropped; surfaces only: the file does not say where points were seen from, so "
        "nothing is free and all else is unknown";
    if (!left.empty()) summary += "; fields not used: " + listed(left);
    try {
        return {Map::fromPoints(points_map, params), summary};
    } catch (const std::invalid_argument& e) {
        failFile(import.input, e.what());
    }
}

Imported importFile(const MapImport& import) {
    const std::string extension = std::filesystem::path(import.input).extension();
    const bool isCloud = extension == ".pcd" || extension == ".ply";
    if (!isCloud && (import.unitsPerMetre || import.resolution_m))
        throw std::runtime_error(
            "--units-per-metre and --resolution are for .pcd and .ply; cells have theirs");
    if (import.height_m && extension != ".yaml" && extension != ".yml")
        throw std::runtime_error("--height is for .yaml");
    if (extension == ".bt" || extension == ".ot")
        return fromCells(readOctree(import.input), import.input);
    if (extension == ".yaml" || extension == ".yml") return fromRosMap(import);
    if (extension == ".pcd") return fromCloud(import, readPcd(import.input));
    if (extension == ".ply") return fromCloud(import, readPly(import.input));
    failFile(import.input, "ends in none of .bt .ot .yaml .pcd .ply");
}

}  // namespace

void importMap(const MapImport& import) {
    mrpt_bridge::checkOutputs({{import.output, mrpt_bridge::FileKind::map}}, {import.input},
                              import.replace);
    Imported imported = importFile(import);
    mrpt::maps::CHGMMOccupancyMap map;
    map.insertionOptions.params = imported.map.params();
    map.model() = std::move(imported.map);
    map.saveToFile(import.output, import.replace == mrpt_bridge::Replace::anyKind);
    std::cout << "imported " << imported.summary << ". " << map.model().mixture().size()
              << " components, written to " << import.output << std::endl;
}

}  // namespace hgmm::importer
