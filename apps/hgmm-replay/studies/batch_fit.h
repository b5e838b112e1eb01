#pragma once
#include <cstddef>

#include "hgmm/em.h"
#include "hgmm/hierarchy.h"
#include "hgmm/mixture.h"
#include "studies/sample_pool.h"

namespace replay {

/// A first guess of a mixture of all samples: the moments of the samples in each cell of
/// the coarsest grid with at least `size` cells, merged down to at most `size` components.
hgmm::Mixture<3> batchGuess(const SamplePool& pool, std::size_t size,
                            const hgmm::HierarchyParams& params);

/// The same mixture with its components of most support split in two along their longest
/// axis, moments being kept, until there are `size` of them.
hgmm::Mixture<3> splitToSize(const hgmm::Mixture<3>& mixture, std::size_t size);

/// EM over all samples at once, neighbourhoods being found anew every few iterations, and
/// components that EM empties or `initial` lacks being made up for by splitToSize: the
/// result has `size` components but for those that the last iterations empty. Throws
/// std::invalid_argument for an empty initial mixture.
hgmm::Mixture<3> batchFit(const hgmm::Mixture<3>& samples, const hgmm::Mixture<3>& initial,
                          std::size_t size);

}  // namespace replay
