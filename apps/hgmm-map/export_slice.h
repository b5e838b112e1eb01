#pragma once
#include <mrpt/maps/CHGMMOccupancyMap.h>

#include "commands.h"

namespace maptool {

/// Writes a horizontal slice as ROS' map_server reads it: `options.output`, YAML, and a PGM
/// picture beside it with 0 for occupied, 254 for free and 205 for unknown. A cell is
/// occupied if anything in the cube about the slice's height is.
///
/// Throws std::runtime_error naming the file, and if the map knows nothing at this height.
void exportSlice(const hgmm::Map& map, const ExportOptions& options);

/// NAME.pgm.
std::string pictureBeside(const std::string& yaml);

}  // namespace maptool
