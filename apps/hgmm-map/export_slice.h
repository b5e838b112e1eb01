#pragma once
#include <Eigen/Core>

#include "commands.h"
#include "hgmm/map.h"

namespace maptool {

/// Writes a horizontal slice as ROS' map_server reads it: `options.output`, YAML, and a PGM
/// picture beside it with 0 for occupied, 254 for free and 205 for unknown. A cell is
/// occupied if anything in the cube about the slice's height is, or anywhere in the band.
///
/// Throws std::runtime_error naming the file, and if the map knows nothing at this height.
void exportSlice(const hgmm::Map& map, const ExportOptions& options);

/// The cells of a slice.
struct SliceFrame {
    double resolution_m = 0;
    std::size_t width = 0, height = 0;    ///< [cells]
    Eigen::Vector2d lowerLeft_map{0, 0};  ///< outer corner [m]
};
/// The frame of the slice that exportSlice would write. Throws as it does.
SliceFrame sliceFrameOf(const hgmm::Map& map, const ExportOptions& options);

/// NAME.pgm.
std::string pictureBeside(const std::string& yaml);

}  // namespace maptool
