#pragma once
#include <mrpt/maps/CHGMMOccupancyMap.h>

#include "commands.h"

namespace maptool {

/// Writes occupied and free space as an octomap::OcTree: log-odds (`ot`) or one bit per
/// leaf (`bt`). Unknown space has no leaves. Log-odds are clamped as OctoMap's own are, and
/// the tree is pruned. The file appears whole or not at all.
///
/// With an offset, the tree is shifted by it, and it is printed and written to a text file
/// beside the tree, NAME.offset.txt: what is to be added to the tree's points.
///
/// Throws std::runtime_error naming the file, and for a map farther than the 32768 cells to
/// each side of the origin that an octree can hold.
void exportOctree(const hgmm::Map& map, const ExportOptions& options);

/// NAME.offset.txt.
std::string offsetBeside(const std::string& tree);

}  // namespace maptool
