#pragma once
#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "hgmm/em.h"
#include "hgmm/lattice.h"
#include "hgmm/mixture.h"

namespace hgmm {

struct Thinning;

/// The first guess of a mixture: moments of the samples in each cell of a voxel grid,
/// thesis 3.3.4 ("a voxel-grid filter ... indicative of the overestimate for lambda_f").
struct CellParams {
    /// Cell edge at range 1 m [m], > 0; grows with the square root of the range.
    double cellAtOneMetre_m = 0.22;
    double minCell_m = 0.04;  ///< smallest cell edge [m], > 0
    int minSamples = 5;  ///< a cell with fewer joins a cell twice its size [count], >= 1

    /// Cell edge at a range [m]; the lattice rounds it down to an octave.
    double edgeAt(double range_m) const {
        return std::max(minCell_m, cellAtOneMetre_m * std::sqrt(range_m));
    }

    /// Throws std::invalid_argument naming the field.
    void validate() const;
};

/// The cell of each sample: as small as the sample's own range says, but with `minSamples`
/// in it where two doublings can reach them.
/// @param means of the samples, in the frame of the origin
std::vector<LatticeCell> assignCells(const std::array<std::vector<float>, 3>& means,
                                     const Eigen::Vector3d& sensorOrigin,
                                     const CellParams& params);

/// An overestimate of the fidelity threshold, ready for fitSparse.
struct InitialMixture {
    Mixture<3> mixture;             ///< one component per cell, or part of a cell
    Neighbourhoods neighbourhoods;  ///< a sample's component and those near it
};

/// Cells follow each sample's own range |sample - sensorOrigin| in octaves. Samples and
/// origin are in the same frame.
///
/// With a `thinning`, whose sensorOrigin is the same, doubled cells with samples that are
/// learnt again are cut in two across the surface while they are thicker than the limit:
/// few hits in a large cell, of the leaves of a bush or of the edge of a thing with what is
/// behind, make a component that explains none of them when they are seen again.
InitialMixture initialiseFromCells(const Mixture<3>& samples,
                                   const Eigen::Vector3d& sensorOrigin,
                                   const CellParams& params,
                                   const Thinning* thinning = nullptr);

}  // namespace hgmm
