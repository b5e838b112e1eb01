#pragma once
#include "hgmm/mixture.h"
#include "hgmm/params.h"
#include "hgmm/scan.h"
#include "occupancy/coverage.h"

namespace hgmm {

/// Marks the cells that the rays of a scan pass, those that end on samples and those that
/// clear. Of rays less than a cell apart it walks those parts that pass other cells.
/// @param samples of the scan, in the local frame
void markRays(const Mixture<3>& samples, const ScanSamples& scan,
              const Pose& T_local_sensor, const CoverageParams& params, Coverage& coverage);

}  // namespace hgmm
