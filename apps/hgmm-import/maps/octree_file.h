#pragma once
#include <hgmm/known_cells.h>

#include <string>

namespace hgmm::importer {

/// The leaves of an octree of OctoMap, .bt or .ot, of type OcTree or ColorOcTree. A leaf is
/// occupied from P(occ) = 0.5 on. Throws std::runtime_error naming the file if it is no
/// such tree, ends early, or is deeper than OctoMap's trees are.
KnownCells readOctree(const std::string& file);

}  // namespace hgmm::importer
