#pragma once
#include "hgmm/mixture.h"
#include "scan/cells.h"

namespace hgmm {

/// Lets samples of a sparse scan speak for the surface between them: the rings of a lidar
/// leave gaps far wider than the distance of points along a ring, and a mixture fitted to
/// lines would call the wall between them unknown.
///
/// Where the samples of a cell (CellParams) do not spread in two directions, larger cells
/// around it are tried, up to kGapDoublings doublings. The first whose samples lie on a
/// plane tells the direction of the gap, in the plane and across the line, and its width;
/// the covariance of the samples grows along it so that their Gaussians meet. Samples on
/// rough ground, vegetation, or with nothing around them stay as they are, and so do those
/// before a gap in which rays go far beyond the plane, and those of a plane that holds the
/// sensor: that of the rays of a planar laser.
///
/// @param samples in the sensor frame; only covariances change
void interpolateRings(Mixture<3>& samples, const CellParams& params);

}  // namespace hgmm
