#include "export_slice.h"

#include <cmath>
#include <cstdio>
#include <filesystem>
#include <stdexcept>

#include "hgmm/mrpt_bridge/output_file.h"
#include "hgmm/mrpt_bridge/voxel_grid.h"
#include "load.h"

namespace maptool {
namespace {

using hgmm::mrpt_bridge::Voxel;
using hgmm::mrpt_bridge::VoxelGrid;

constexpr char kOccupied = 0;
constexpr char kFree = static_cast<char>(254);
constexpr char kUnknown = static_cast<char>(205);

/// Rows from the north (highest y) to the south, as PGM and map_server have it.
struct Slice {
    std::size_t width = 0, height = 0;    ///< [cells]
    Eigen::Vector2d lowerLeft_map{0, 0};  ///< outer corner [m]
    std::string cells;
};

Slice sliceOf(const VoxelGrid& grid) {
    Eigen::Vector2d low = grid.voxels.front().centre_map.head<2>(), high = low;
    for (const Voxel& voxel : grid.voxels) {
        low = low.cwiseMin(voxel.centre_map.head<2>());
        high = high.cwiseMax(voxel.centre_map.head<2>());
    }
    const auto cellsFrom = [&](double from, double to) {
        return static_cast<std::size_t>(std::llround((to - from) / grid.resolution_m));
    };
    Slice slice;
    slice.width = cellsFrom(low.x(), high.x()) + 1;
    slice.height = cellsFrom(low.y(), high.y()) + 1;
    slice.lowerLeft_map = low.array() - 0.5 * grid.resolution_m;
    constexpr std::size_t maxCells = std::size_t{1} << 30U;
    if (slice.width > maxCells / slice.height)
        throw std::runtime_error("a picture of " + std::to_string(slice.width) + " x " +
                                 std::to_string(slice.height) +
                                 " cells is too large: choose a larger --resolution");
    slice.cells.assign(slice.width * slice.height, kUnknown);
    for (const Voxel& voxel : grid.voxels)
        slice.cells[cellsFrom(voxel.centre_map.y(), high.y()) * slice.width +
                    cellsFrom(low.x(), voxel.centre_map.x())] =
            voxel.occupied ? kOccupied : kFree;
    return slice;
}

std::string yamlOf(const Slice& slice, double resolution_m, const std::string& image) {
    char text[400];
    // Thresholds on p = (255 - cell) / 255, which is .196 for unknown cells: they must not
    // pass for free.
    std::snprintf(text, sizeof text,
                  "image: %s\nresolution: %.9g\norigin: [%.9g, %.9g, 0.0]\nnegate: 0\n"
                  "occupied_thresh: 0.65\nfree_thresh: 0.19\n",
                  image.c_str(), resolution_m, slice.lowerLeft_map.x(),
                  slice.lowerLeft_map.y());
    return text;
}

}  // namespace

std::string pictureBeside(const std::string& yaml) {
    return std::filesystem::path(yaml).replace_extension(".pgm").string();
}

void exportSlice(const hgmm::Map& map, const ExportOptions& options) {
    levelOf(map, options.level, options.mapFile);
    hgmm::mrpt_bridge::VoxelParams params;
    params.level = options.level;
    params.resolution_m = options.resolution_m;
    params.height_m = options.height_m;
    const VoxelGrid grid = hgmm::mrpt_bridge::voxelise(map, params);
    if (grid.voxels.empty())
        throw std::runtime_error(options.mapFile + ": knows nothing at a height of " +
                                 std::to_string(*options.height_m) +
                                 " m; hgmm-map info tells its extent");
    const Slice slice = sliceOf(grid);
    const std::string picture = pictureBeside(options.output);
    const std::string cells = "P5\n" + std::to_string(slice.width) + " " +
                              std::to_string(slice.height) + "\n255\n" + slice.cells;
    const std::string yaml =
        yamlOf(slice, grid.resolution_m, std::filesystem::path(picture).filename());
    hgmm::mrpt_bridge::writeFiles({{picture, cells}, {options.output, yaml}},
                                  replaceFor(options.force));
}

}  // namespace maptool
