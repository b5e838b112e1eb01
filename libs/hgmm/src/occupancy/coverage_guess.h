#pragma once
#include "hgmm/mixture.h"
#include "hgmm/params.h"
#include "hgmm/view_directions.h"
#include "occupancy/coverage.h"

namespace hgmm {

/// Coverage of a map that was saved before maps had any: the inside of its free components
/// and the bands before its surfaces, where such maps said that they know.
Coverage guessedCoverage(const Mixture<3>& surfaces, const ViewDirections& views,
                         const Mixture<4>& free, const OccupancyParams& params);

}  // namespace hgmm
