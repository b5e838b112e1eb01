#pragma once
#include <Eigen/Core>
#include <cstddef>
#include <optional>
#include <vector>

#include "hgmm/map.h"

namespace hgmm::mrpt_bridge {

/// Which cells of a lattice are asked for.
struct VoxelParams {
    /// Edge [m], 1e-4 to 1e4. 0: the typical extent of a surface component within its
    /// surface, rounded to 1, 2 or 5 times a power of ten, and more where that would make
    /// over kMaxDerivedCells cells.
    double resolution_m = 0.0;
    double minOccupied = 0.5;  ///< P(occ) from which a cell is occupied [1], 0.01 to 0.99
    std::size_t level = 0;     ///< of the hierarchy, 0 the finest
    bool occupied = true;      ///< whether occupied cells are wanted
    bool free = true;          ///< whether free cells are wanted
    /// Only the one layer of cells whose centres are at this height [m].
    std::optional<double> height_m;

    static constexpr std::size_t kMaxDerivedCells = std::size_t{1} << 18U;
    static constexpr std::size_t kMaxCells = std::size_t{1} << 24U;

    /// Throws std::invalid_argument naming the field.
    void validate() const;
};

/// One cube and what the map says of it.
struct Voxel {
    Eigen::Vector3d centre_map;  ///< [m]
    /// The answer with the highest P(occ) among those at the cell's centre, at the means of
    /// surface components and where their mid-planes cross the cell: what is thinner or
    /// smaller than a cell counts.
    Occupancy occupancy;
    Eigen::Vector3d place_map;  ///< where in the cell that answer was given [m]
    bool occupied;              ///< P(occ) >= minOccupied; otherwise P(free) > 0.5
};

/// Cells that are occupied or free; all others are unknown or undecided.
struct VoxelGrid {
    double resolution_m = 0.0;  ///< edge of a cell [m]; 0 for an empty map
    std::vector<Voxel> voxels;  ///< in a fixed order
};

/// Asks a map about the cells near its components. Cell (i, j, k) spans
/// [i, i+1) x [j, j+1) x [k, k+1) resolutions of the map frame, as in OctoMap; with
/// height_m, k is shifted.
///
/// Throws std::invalid_argument for params out of range and for a resolution at which the
/// map has more than kMaxCells cells, std::out_of_range for a level that does not exist.
VoxelGrid voxelise(const Map& map, const VoxelParams& params);

}  // namespace hgmm::mrpt_bridge
