#pragma once
#include <Eigen/Core>
#include <vector>

#include "cell_map/cell_set.h"
#include "hgmm/mixture.h"
#include "hgmm/params.h"

namespace hgmm {

/// Samples of surfaces that are seen from one side, each with the cell that it is in.
struct CellSamples {
    Eigen::Vector3d direction = Eigen::Vector3d::Zero();  ///< to that side; zero: not known
    Mixture<3> samples;                                   ///< in the local frame
    std::vector<CellSet::Cell> cells;                     ///< of each sample
};

/// The outer faces of occupied cells, those that border on free ones, by the six directions
/// that they face; last, the occupied cells without an outer face. A face counts as one
/// hit in the middle of its cell.
/// @param T_local_cells pose of the frame of the cells, which have edges of `edge_m`
std::vector<CellSamples> outerFaces(const CellSet& occupied, const CellSet& free,
                                    double edge_m, const Pose& T_local_cells);

/// The moments of the points in each cell of a lattice in the local frame, with the noise
/// of the sensor: samples without a side.
CellSamples pointSamples(const std::vector<Eigen::Vector3d>& points_local, double edge_m,
                         double noise_m);

/// EM from an overestimate, as for the novel samples of a scan. The first guess has a
/// component for each part of a tile of cells whose cells touch each other: what lies in
/// between stays empty.
Mixture<3> fitSurfaces(const CellSamples& surfaces, const EmParams& params);

}  // namespace hgmm
