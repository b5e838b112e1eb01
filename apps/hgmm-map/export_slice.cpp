#include "export_slice.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <stdexcept>
#include <vector>

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
constexpr std::size_t kMostLayers = 2000;

/// The layers that a slice is made of, by their heights [m].
std::vector<double> heightsOf(const ExportOptions& options, double resolution_m) {
    if (options.height_m) return {*options.height_m};
    const double low = options.band_m[0], high = options.band_m[1];
    const auto layers =
        static_cast<std::size_t>(std::ceil((high - low) / resolution_m - 1e-9));
    if (layers > kMostLayers)
        throw std::runtime_error("a band of " + std::to_string(layers) +
                                 " layers of cells is too high: choose a larger "
                                 "--resolution");
    std::vector<double> heights;
    // The last layer ends with the band.
    for (std::size_t k = 0; k < layers; ++k)
        heights.push_back(std::max(
            low + resolution_m / 2,
            std::min(low + (double(k) + 0.5) * resolution_m, high - resolution_m / 2)));
    return heights;
}

/// What the layers know, one after the other.
VoxelGrid layersOf(const hgmm::Map& map, const ExportOptions& options) {
    hgmm::mrpt_bridge::VoxelParams params;
    params.level = options.level;
    params.resolution_m = options.resolution_m;
    if (params.resolution_m == 0) {
        // Of one layer, or of all of the map.
        params.height_m = options.height_m;
        params.resolution_m = hgmm::mrpt_bridge::voxelise(map, params).resolution_m;
    }
    VoxelGrid grid;
    grid.resolution_m = params.resolution_m;
    if (grid.resolution_m == 0) return grid;
    for (const double height_m : heightsOf(options, grid.resolution_m)) {
        params.height_m = height_m;
        const VoxelGrid layer = hgmm::mrpt_bridge::voxelise(map, params);
        grid.voxels.insert(grid.voxels.end(), layer.voxels.begin(), layer.voxels.end());
    }
    return grid;
}

std::string heightText(const ExportOptions& options) {
    if (options.height_m)
        return "at a height of " + std::to_string(*options.height_m) + " m";
    return "from " + std::to_string(options.band_m[0]) + " to " +
           std::to_string(options.band_m[1]) + " m";
}

SliceFrame frameOf(const VoxelGrid& grid, const ExportOptions& options) {
    if (grid.voxels.empty())
        throw std::runtime_error(options.mapFile + ": knows nothing " +
                                 heightText(options) + "; hgmm-map info tells its extent");
    Eigen::Vector2d low = grid.voxels.front().centre_map.head<2>(), high = low;
    for (const Voxel& voxel : grid.voxels) {
        low = low.cwiseMin(voxel.centre_map.head<2>());
        high = high.cwiseMax(voxel.centre_map.head<2>());
    }
    const Eigen::Vector2d cells = (high - low) / grid.resolution_m;
    SliceFrame frame;
    frame.resolution_m = grid.resolution_m;
    frame.width = static_cast<std::size_t>(std::llround(cells.x())) + 1;
    frame.height = static_cast<std::size_t>(std::llround(cells.y())) + 1;
    frame.lowerLeft_map = low.array() - 0.5 * grid.resolution_m;
    constexpr std::size_t maxCells = std::size_t{1} << 30U;
    if (frame.width > maxCells / frame.height)
        throw std::runtime_error("a picture of " + std::to_string(frame.width) + " x " +
                                 std::to_string(frame.height) +
                                 " cells is too large: choose a larger --resolution");
    return frame;
}

/// Rows from the north (highest y) to the south, as PGM and map_server have it.
std::string cellsOf(const VoxelGrid& grid, const SliceFrame& frame) {
    std::string cells(frame.width * frame.height, kUnknown);
    for (const Voxel& voxel : grid.voxels) {
        const Eigen::Vector2d at =
            (voxel.centre_map.head<2>() - frame.lowerLeft_map) / grid.resolution_m;
        char& cell = cells[(frame.height - 1 - std::size_t(at.y())) * frame.width +
                           std::size_t(at.x())];
        if (voxel.occupied)
            cell = kOccupied;
        else if (cell == kUnknown)
            cell = kFree;
    }
    return cells;
}

std::string yamlOf(const SliceFrame& frame, const std::string& image) {
    char text[400];
    // Thresholds on p = (255 - cell) / 255, which is .196 for unknown cells: they must not
    // pass for free.
    std::snprintf(text, sizeof text,
                  "image: %s\nresolution: %.9g\norigin: [%.9g, %.9g, 0.0]\nnegate: 0\n"
                  "occupied_thresh: 0.65\nfree_thresh: 0.19\n",
                  image.c_str(), frame.resolution_m, frame.lowerLeft_map.x(),
                  frame.lowerLeft_map.y());
    return text;
}

}  // namespace

std::string pictureBeside(const std::string& yaml) {
    return std::filesystem::path(yaml).replace_extension(".pgm").string();
}

SliceFrame sliceFrameOf(const hgmm::Map& map, const ExportOptions& options) {
    return frameOf(layersOf(map, options), options);
}

void exportSlice(const hgmm::Map& map, const ExportOptions& options) {
    levelOf(map, options.level, options.mapFile);
    const VoxelGrid grid = layersOf(map, options);
    const SliceFrame frame = frameOf(grid, options);
    const std::string picture = pictureBeside(options.output);
    const std::string cells = "P5\n" + std::to_string(frame.width) + " " +
                              std::to_string(frame.height) + "\n255\n" +
                              cellsOf(grid, frame);
    const std::string yaml = yamlOf(frame, std::filesystem::path(picture).filename());
    hgmm::mrpt_bridge::writeFiles({{picture, cells}, {options.output, yaml}},
                                  replaceFor(options.force));
}

}  // namespace maptool
