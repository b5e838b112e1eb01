#pragma once
#include <cstddef>
#include <cstdint>
#include <vector>

#include "hgmm/export.h"
#include "hgmm/mixture.h"

namespace hgmm {

/// Draws n points from a mixture. Axis d of point i is at [i * D + d]. The same seed gives
/// the same points on every machine with the same standard library. Throws
/// std::invalid_argument if the mixture is empty and n > 0. The library has it for D = 3.
template <int D>
HGMM_EXPORT std::vector<float> samplePoints(const Mixture<D>& mixture, std::size_t n,
                                            std::uint64_t seed);

}  // namespace hgmm
