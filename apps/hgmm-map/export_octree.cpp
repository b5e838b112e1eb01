#include "export_octree.h"

#include <octomap/OcTree.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <iostream>
#include <sstream>
#include <stdexcept>

#include "hgmm/mrpt_bridge/output_file.h"
#include "hgmm/mrpt_bridge/voxel_grid.h"
#include "load.h"

namespace maptool {
namespace {

float clampedLogOdds(double probability, const octomap::OcTree& tree) {
    const double p =
        std::clamp(probability, tree.getClampingThresMin(), tree.getClampingThresMax());
    return static_cast<float>(std::log(p / (1.0 - p)));
}

void enter(const hgmm::mrpt_bridge::Voxel& voxel, const Eigen::Vector3d& offset_map,
           const std::string& file, octomap::OcTree& tree) {
    const Eigen::Vector3d p = voxel.centre_map - offset_map;
    octomap::OcTreeKey key;
    // In double: octomap's own points are floats, too coarse far from the origin.
    for (int axis = 0; axis < 3; ++axis)
        if (!tree.coordToKeyChecked(p[axis], key[axis]))
            throw std::runtime_error(
                file + ": an octree of " + std::to_string(tree.getResolution()) +
                " m reaches " + std::to_string(32768 * tree.getResolution()) +
                " m from the origin, and the map farther; give --local or --offset X,Y,Z, "
                "or choose a larger --resolution");
    constexpr bool innerNodesLater = true;
    tree.setNodeValue(key, clampedLogOdds(voxel.occupancy.probability(), tree),
                      innerNodesLater);
}

/// The point of the map that becomes the tree's origin: on a corner of cells, so that they
/// stay cells.
Eigen::Vector3d offsetOf(const hgmm::Map& map, const ExportOptions& options,
                         double edge_m) {
    Eigen::Vector3d wanted = Eigen::Vector3d::Zero();
    if (options.local) wanted = map.origin();
    if (!options.offset_map.empty())
        wanted = Eigen::Vector3d::Map(options.offset_map.data());
    return edge_m * (wanted / edge_m).array().round();
}

std::string offsetText(const Eigen::Vector3d& offset_map) {
    char text[120];
    std::snprintf(text, sizeof text, "%.9f %.9f %.9f\n", offset_map.x(), offset_map.y(),
                  offset_map.z());
    return text;
}

/// The tree, and where it lies if that was asked for.
void writeTree(const std::string& tree, const Eigen::Vector3d& offset_map,
               const ExportOptions& options) {
    std::vector<hgmm::mrpt_bridge::FileContent> files;
    const std::string text = offsetText(offset_map), file = offsetBeside(options.output);
    const bool hasOffset = options.local || !options.offset_map.empty();
    if (hasOffset) files.push_back({file, text});
    files.push_back({options.output, tree});
    hgmm::mrpt_bridge::writeFiles(files, replaceFor(options.force));
    if (hasOffset)
        std::cout << "offset " << text << "written to " << file
                  << ": add it to the tree's points to have those of the map" << std::endl;
}

}  // namespace

std::string offsetBeside(const std::string& tree) {
    return std::filesystem::path(tree).replace_extension(".offset.txt").string();
}

void exportOctree(const hgmm::Map& map, const ExportOptions& options) {
    levelOf(map, options.level, options.mapFile);
    hgmm::mrpt_bridge::VoxelParams params;
    params.level = options.level;
    params.resolution_m = options.resolution_m;
    const hgmm::mrpt_bridge::VoxelGrid grid = hgmm::mrpt_bridge::voxelise(map, params);
    octomap::OcTree tree(grid.resolution_m);
    const Eigen::Vector3d offset_map = offsetOf(map, options, grid.resolution_m);
    for (const auto& voxel : grid.voxels) enter(voxel, offset_map, options.output, tree);
    tree.updateInnerOccupancy();
    tree.prune();

    std::ostringstream bytes;
    // writeBinary makes leaves certain and prunes again.
    const bool written =
        options.format == "bt" ? tree.writeBinary(bytes) : tree.write(bytes);
    if (!written) throw std::runtime_error(options.output + ": cannot be written");
    writeTree(bytes.str(), offset_map, options);
}

}  // namespace maptool
