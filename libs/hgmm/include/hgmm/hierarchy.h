#pragma once
#include <cstdint>
#include <vector>

#include "hgmm/knee.h"
#include "hgmm/mixture.h"

namespace hgmm {

/// Algorithm 1 of the thesis (3.3.2).
struct HierarchyParams {
    int levels = 5;  ///< L, levels kept from the fidelity threshold up [count], >= 1
    double similarityStart = 0.9;  ///< lambda_d of the first merge pass [nat], > 0
    double similarityStep = 0.2;   ///< added to lambda_d after each pass [nat], >= 0
    /// lambda_d that the fidelity threshold may not need more than [nat], > 0. Adjacent
    /// tiles of one plane differ by about 6 nat, the two sides of an edge by tens.
    double similarityMax = 5.0;
    double levelRatio =
        0.7;  ///< a map's level has at most so much of the one below [1], (0, 1)

    /// Throws std::invalid_argument naming the field.
    void validate() const;
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
Mixture<D> mergePass(const Mixture<D>& mixture, double similarity);

/// Passes with rising similarity until at most `size` components are left, or nothing
/// merges.
/// @param heirs if given, receives the index in the result of the component that took over
/// each component of `mixture`
template <int D>
Mixture<D> mergeToSize(const Mixture<D>& mixture, std::size_t size,
                       const HierarchyParams& params,
                       std::vector<std::uint32_t>* heirs = nullptr);

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
Hierarchy<D> generateHierarchy(const Mixture<D>& reference, const HierarchyParams& params);

}  // namespace hgmm
