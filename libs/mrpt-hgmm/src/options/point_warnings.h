#pragma once
#include "hgmm/params.h"
#include "hgmm/scan.h"

namespace hgmm::mrpt_bridge {

/// Reports that no point of a scan was in range, so that it added no surface; or that its
/// points were too many for leaves of the size asked for.
void warnOfPoints(const FilterCounts& points, const FilterParams& params);

}  // namespace hgmm::mrpt_bridge
