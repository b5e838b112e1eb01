#pragma once
#include "commands.h"
#include "hgmm/map.h"

namespace maptool {

/// Writes the distance to the nearest surface, its standard deviation and the occupancy at
/// the middles of the cells of a slice: all as a CSV, or one of the first two as a PGM
/// picture, whose scale is in its header and printed.
void exportField(const hgmm::Map& map, const ExportOptions& options);

}  // namespace maptool
