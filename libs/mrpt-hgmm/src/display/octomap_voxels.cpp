#include "display/octomap_voxels.h"

#include <algorithm>
#include <limits>
#include <vector>

#include "hgmm/mrpt_bridge/modality_colours.h"
#include "hgmm/mrpt_bridge/voxel_grid.h"

using mrpt::opengl::COctoMapVoxels;

namespace hgmm::mrpt_bridge {

namespace {

/// Corners of the box around all voxels.
struct Bounds {
    Eigen::Vector3d low, high;
};

Bounds boundsOf(const VoxelGrid& grid) {
    if (grid.voxels.empty()) return {Eigen::Vector3d::Zero(), Eigen::Vector3d::Zero()};
    Bounds bounds{grid.voxels.front().centre_map, grid.voxels.front().centre_map};
    for (const Voxel& voxel : grid.voxels) {
        bounds.low = bounds.low.cwiseMin(voxel.centre_map);
        bounds.high = bounds.high.cwiseMax(voxel.centre_map);
    }
    bounds.low.array() -= 0.5 * grid.resolution_m;
    bounds.high.array() += 0.5 * grid.resolution_m;
    return bounds;
}

bool showsModality(const RenderParams& params) {
    return static_cast<EllipsoidColour>(params.colour) == EllipsoidColour::kModality;
}

/// What the mode modulates: the colour of the object, which filters that of the modality
/// where one is shown.
std::vector<mrpt::img::TColorf> baseColours(const Map& map, const RenderParams& params,
                                            const VoxelGrid& grid,
                                            const mrpt::img::TColorf& general) {
    std::vector<mrpt::img::TColorf> colours(grid.voxels.size(), general);
    if (!showsModality(params)) return colours;
    std::vector<std::size_t> occupied;
    std::vector<Eigen::Vector3d> places_map;
    for (std::size_t i = 0; i < grid.voxels.size(); ++i) {
        if (!grid.voxels[i].occupied) continue;
        occupied.push_back(i);
        places_map.push_back(grid.voxels[i].place_map);
    }
    const auto shown = modalityColours(map, params.modality, places_map);
    for (std::size_t k = 0; k < occupied.size(); ++k)
        colours[occupied[k]] = {shown[k].R * general.R, shown[k].G * general.G,
                                shown[k].B * general.B, general.A};
    return colours;
}

mrpt::math::TPoint3D toPoint(const Eigen::Vector3d& p) {
    return {p.x(), p.y(), p.z()};
}

void appendVoxel(const Voxel& voxel, double edge_m, const mrpt::img::TColor& colour,
                 bool gridLines, COctoMapVoxels& target) {
    target.push_back_Voxel(
        voxel.occupied ? mrpt::opengl::VOXEL_SET_OCCUPIED
                       : mrpt::opengl::VOXEL_SET_FREESPACE,
        COctoMapVoxels::TVoxel(toPoint(voxel.centre_map), edge_m, colour));
    if (!gridLines) return;
    const Eigen::Vector3d half = Eigen::Vector3d::Constant(0.5 * edge_m);
    target.push_back_GridCube(COctoMapVoxels::TGridCube(toPoint(voxel.centre_map - half),
                                                        toPoint(voxel.centre_map + half)));
}

}  // namespace

mrpt::img::TColor voxelColour(COctoMapVoxels::visualization_mode_t mode,
                              const mrpt::img::TColorf& general, double probability,
                              double height) {
    constexpr double translucent = 50;  // [0 to 255], of all voxels in one of the modes
    double brightness = 255, opacity = 255.0 * general.A;
    const double fromOccupancy = 15 + 240 * (1 - probability);
    const double opaqueWhereOccupied = std::max(0.0, 255 - 510 * (1 - probability));
    switch (mode) {
        case COctoMapVoxels::COLOR_FROM_HEIGHT:
            brightness = 255 * height;
            break;
        case COctoMapVoxels::COLOR_FROM_OCCUPANCY:
            brightness = fromOccupancy;
            break;
        case COctoMapVoxels::TRANSPARENCY_FROM_OCCUPANCY:
            opacity = opaqueWhereOccupied;
            break;
        case COctoMapVoxels::TRANS_AND_COLOR_FROM_OCCUPANCY:
            brightness = fromOccupancy;
            opacity = translucent;
            break;
        case COctoMapVoxels::MIXED:
            brightness = 255 * height;
            opacity = opaqueWhereOccupied;
            break;
        default:  // FIXED, and colours that come with the data
            break;
    }
    const auto byte = [](double v) {
        return static_cast<std::uint8_t>(std::clamp(v, 0.0, 255.0));
    };
    return {byte(brightness * general.R), byte(brightness * general.G),
            byte(brightness * general.B), byte(opacity)};
}

void fillOctoMapVoxels(const Map& map, const RenderParams& params, COctoMapVoxels& target) {
    params.validate();
    VoxelParams wanted;
    wanted.resolution_m = params.voxelResolution_m;
    wanted.minOccupied = params.minOccupied;
    wanted.level = std::min(static_cast<std::size_t>(params.level), map.levelCount() - 1);
    wanted.occupied = params.generateOccupiedVoxels;
    wanted.free = params.generateFreeVoxels;
    const VoxelGrid grid = voxelise(map, wanted);

    target.clear();
    target.resizeVoxelSets(2);
    target.showVoxels(mrpt::opengl::VOXEL_SET_OCCUPIED, params.visibleOccupiedVoxels);
    target.showVoxels(mrpt::opengl::VOXEL_SET_FREESPACE, params.visibleFreeVoxels);
    const Bounds bounds = boundsOf(grid);
    const double margin_m = 0.01;  // COctoMap's: a flat map has no height to divide by
    const std::vector<mrpt::img::TColorf> base =
        baseColours(map, params, grid, target.getColor());
    for (std::size_t i = 0; i < grid.voxels.size(); ++i) {
        const Voxel& voxel = grid.voxels[i];
        const double height = (voxel.centre_map.z() - bounds.low.z()) /
                              (bounds.high.z() - bounds.low.z() + margin_m);
        appendVoxel(voxel, grid.resolution_m,
                    voxelColour(target.getVisualizationMode(), base[i],
                                voxel.occupancy.probability(), height),
                    params.generateGridLines, target);
    }
    // Translucent cubes are drawn in order, so that those below shine through.
    if (target.isCubeTransparencyEnabled()) target.sort_voxels_by_z();
    target.setBoundingBox(toPoint(bounds.low), toPoint(bounds.high));
}

void appendVoxels(const Map& map, const RenderParams& params,
                  mrpt::opengl::CSetOfObjects& objects) {
    if (!params.drawVoxels) return;
    auto voxels = COctoMapVoxels::Create();
    voxels->setVisualizationMode(showsModality(params) ? COctoMapVoxels::FIXED
                                                       : COctoMapVoxels::COLOR_FROM_HEIGHT);
    fillOctoMapVoxels(map, params, *voxels);
    voxels->showGridLines(params.generateGridLines);
    objects.insert(voxels);
}

}  // namespace hgmm::mrpt_bridge
