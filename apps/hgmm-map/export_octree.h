#pragma once
#include <mrpt/maps/CHGMMOccupancyMap.h>

#include "commands.h"

namespace maptool {

/// Writes occupied and free space as an octomap::OcTree: log-odds (`ot`) or one bit per
/// leaf (`bt`). Unknown space has no leaves. Log-odds are clamped as OctoMap's own are, and
/// the tree is pruned. The file appears whole or not at all.
///
/// Throws std::runtime_error naming the file, and for a map larger than the 32768 cells to
/// each side of the origin that an octree can hold.
void exportOctree(const hgmm::Map& map, const ExportOptions& options);

}  // namespace maptool
