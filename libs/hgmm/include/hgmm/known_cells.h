#pragma once
#include <array>
#include <cstdint>
#include <vector>

#include "hgmm/export.h"
#include "hgmm/scan.h"

namespace hgmm {

/// A cube of `size` cells along each edge, from its lowest cell on.
struct CellCube {
    std::array<std::int32_t, 3> low = {0, 0, 0};  ///< [cells]
    std::int32_t size = 1;                        ///< [cells], >= 1
};

/// What a map of another kind knows, as octrees and grids do: cells of one lattice that are
/// occupied or free; all others are unknown. Cell (i, j, k) spans [i, i+1) x [j, j+1) x
/// [k, k+1) edges of the frame of the cells.
struct KnownCells {
    static constexpr std::int32_t kFarthest = 1 << 24;  ///< of a cell [cells]

    double edge_m = 0;               ///< [m], in [1e-3, 100]
    Pose T_map_cells;                ///< pose of the frame of the cells in the map frame
    std::vector<CellCube> occupied;  ///< where they meet free cubes, they win
    std::vector<CellCube> free;

    /// Throws std::invalid_argument if the edge is out of range, the pose is not finite or
    /// not rigid, or a cube is empty or reaches farther than kFarthest.
    HGMM_EXPORT void validate() const;
};

}  // namespace hgmm
