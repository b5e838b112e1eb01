#pragma once
#include "cell_map/cell_set.h"
#include "occupancy/coverage.h"
#include "occupancy/free_space.h"

namespace hgmm {

/// Coverage of free cells, as if rays had passed everywhere in them and nowhere else.
/// Lattices are as coarse as they can be inside, and smaller than the free cells where
/// these end.
/// @param T_local_cells pose of the frame of the cells, which have edges of `edge_m`
Coverage coverageOf(const CellSet& free, double edge_m, const Pose& T_local_cells);

/// The free cells as components over place and the distance to surfaces: small ones beside
/// occupied cells, where they weigh against the tails of surfaces, and large ones
/// elsewhere, whose distance is rough.
FreeSpace freeComponents(const CellSet& occupied, const CellSet& free, double edge_m,
                         const Pose& T_local_cells);

}  // namespace hgmm
