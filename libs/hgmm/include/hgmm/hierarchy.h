#pragma once
#include <cstdint>
#include <vector>

#include "hgmm/export.h"
#include "hgmm/mixture.h"
#include "hgmm/params.h"

namespace hgmm {

/// One point of the divergence curve of thesis fig. 3.2.
struct DivergencePoint {
    std::size_t size = 0;     ///< components of the level
    double divergence = 0.0;  ///< KL(G_0 || G_l), eq. (3.15) [nat]; that can dip below 0
    double similarity = 0.0;  ///< lambda_d of the merge pass that made it [nat]
};

template <int D>
struct Hierarchy {
    /// [0] has the size of the fidelity threshold; 1 to params.levels of them
    std::vector<Mixture<D>> levels;
    std::vector<DivergencePoint> curve;  ///< of the passes, from the reference on
    std::size_t knee = 0;                ///< index in curve of levels[0]
};

/// One pass of lines 6-16: each component absorbs every later one for which
/// min(KL(i, j), KL(j, i)) < similarity; moments are kept exactly.
template <int D>
HGMM_EXPORT Mixture<D> mergePass(const Mixture<D>& mixture, double similarity);

/// Passes with rising similarity until at most `size` components are left, or nothing
/// merges.
/// @param parentOf if given, receives the index in the result of the component that took
/// over each component of `mixture`
template <int D>
HGMM_EXPORT Mixture<D> mergeToSize(const Mixture<D>& mixture, std::size_t size,
                                   const HierarchyParams& params,
                                   std::vector<std::uint32_t>* parentOf = nullptr);

/// Merges `reference` (an overestimate of the fidelity threshold) in passes, takes the knee
/// of the divergence curve KL(G_0 || G_l) for the fidelity threshold (findKnee()), or the
/// last mixture that needed no more than similarityMax if that is larger, and keeps levels
/// from there on. It stops when the knee and params.levels levels are known, a single
/// component is left or nothing merges any more.
///
/// lambda_d rises by similarityStep a pass, and beyond 4 nat by similarityStep / 4 of its
/// value, so that the number of passes grows with the logarithm of the largest divergence
/// only. A pass that merges nothing makes no level. An empty reference gives one empty
/// level.
template <int D>
HGMM_EXPORT Hierarchy<D> generateHierarchy(const Mixture<D>& reference,
                                           const HierarchyParams& params);

}  // namespace hgmm
