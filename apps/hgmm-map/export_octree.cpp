#include "export_octree.h"

#include <octomap/OcTree.h>

#include <algorithm>
#include <cmath>
#include <sstream>
#include <stdexcept>

#include "hgmm/evaluation/metrics_json.h"
#include "hgmm/mrpt_bridge/voxel_grid.h"
#include "load.h"

namespace maptool {
namespace {

float clampedLogOdds(double probability, const octomap::OcTree& tree) {
    const double p =
        std::clamp(probability, tree.getClampingThresMin(), tree.getClampingThresMax());
    return static_cast<float>(std::log(p / (1.0 - p)));
}

void enter(const hgmm::mrpt_bridge::Voxel& voxel, const std::string& file,
           octomap::OcTree& tree) {
    const Eigen::Vector3d& p = voxel.centre_map;
    octomap::OcTreeKey key;
    // In double: octomap's own points are floats, too coarse far from the origin.
    for (int axis = 0; axis < 3; ++axis)
        if (!tree.coordToKeyChecked(p[axis], key[axis]))
            throw std::runtime_error(
                file + ": an octree of " + std::to_string(tree.getResolution()) +
                " m reaches " + std::to_string(32768 * tree.getResolution()) +
                " m from the origin, and the map farther; choose a larger --resolution");
    constexpr bool innerNodesLater = true;
    tree.setNodeValue(key, clampedLogOdds(voxel.occupancy.probability(), tree),
                      innerNodesLater);
}

}  // namespace

void exportOctree(const hgmm::Map& map, const ExportOptions& options) {
    levelOf(map, options.level, options.mapFile);
    hgmm::mrpt_bridge::VoxelParams params;
    params.level = options.level;
    params.resolution_m = options.resolution_m;
    const hgmm::mrpt_bridge::VoxelGrid grid = hgmm::mrpt_bridge::voxelise(map, params);
    octomap::OcTree tree(grid.resolution_m);
    for (const auto& voxel : grid.voxels) enter(voxel, options.output, tree);
    tree.updateInnerOccupancy();
    tree.prune();

    std::ostringstream bytes;
    // writeBinary makes leaves certain and prunes again.
    const bool written =
        options.format == "bt" ? tree.writeBinary(bytes) : tree.write(bytes);
    if (!written) throw std::runtime_error(options.output + ": cannot be written");
    hgmm::evaluation::writeTextFile(options.output, bytes.str());
}

}  // namespace maptool
