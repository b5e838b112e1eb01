#pragma once
#include <vector>

#include "hgmm/params.h"
#include "hgmm/scan.h"

namespace hgmm {

/// Rays that clear space and mark nothing at their end: those of the points beyond
/// maxRange_m, and the scan's own of at least minRange_m, all cut at maxRange_m. Of rays
/// that end in one leaf of the filter, the first stays.
/// @param scan valid (Scan::validate)
std::vector<ClearedRay> clearedRaysOf(const Scan& scan, const FilterParams& params);

}  // namespace hgmm
