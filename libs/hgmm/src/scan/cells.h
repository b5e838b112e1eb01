#pragma once
#include <array>
#include <cstdint>
#include <vector>

#include "base/lattice.h"
#include "hgmm/em.h"
#include "hgmm/mixture.h"

namespace hgmm {

/// The cell of each sample: as small as the sample's own range says, but with `minSamples`
/// in it where two doublings can reach them.
/// @param means of the samples, in the frame of the origin
std::vector<LatticeCell> assignCells(const std::array<std::vector<float>, 3>& means,
                                     const Eigen::Vector3d& sensorOrigin,
                                     const CellParams& params);

/// A first guess in the making: the moments of the samples in each cell.
struct CellMoments {
    std::vector<LatticeCell> cellOf;         ///< of each sample
    std::vector<std::uint32_t> componentOf;  ///< of each sample
    std::vector<Gaussian<3>> components;     ///< moments of their samples
};

/// Samples and origin are in the same frame.
CellMoments momentsOfCells(const Mixture<3>& samples, const Eigen::Vector3d& sensorOrigin,
                           const CellParams& params);

/// The guess as a mixture, with the components near each sample.
InitialMixture initialMixture(const Mixture<3>& samples, const CellMoments& guess);

}  // namespace hgmm
