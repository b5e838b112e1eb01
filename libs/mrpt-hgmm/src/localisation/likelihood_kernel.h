#pragma once
#include <optional>

#include "hgmm/mrpt_bridge/likelihood_params.h"
#include "localisation/pose_spread.h"

namespace hgmm::mrpt_bridge {

/// How points are compared with the map: what LikelihoodParams say, without their zeros.
struct LikelihoodKernel {
    double kernelWidth_m;      ///< [m]
    double outlierRatio;       ///< in (0, 1)
    double independentPoints;  ///< [count]
    double shareOfPoints;      ///< of those that maxPoints allows, in (0, 1]
};

/// The kernel that options fix, if one of them does.
std::optional<LikelihoodKernel> fixedKernel(const LikelihoodParams& params);

/// The kernel where several maps are asked about one pose each: particles of a mapping
/// filter that do not search. How far a pose may be off in its map is the noise of a step
/// then, which nothing asked tells: as wide as at a global start, but all points count, for
/// what is sought is the best of few particles.
LikelihoodKernel kernelWithoutSearch();

/// The kernel for poses of such a spread. A narrow one tells the poses of a converged
/// filter apart. A wide one, with few independent points, lets the particles of a global
/// start live on where none is near the truth yet; it serves where nothing is known.
LikelihoodKernel kernelFor(const std::optional<PoseSpread>& spread);

}  // namespace hgmm::mrpt_bridge
