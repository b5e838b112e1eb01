#pragma once
#include <mrpt/obs/CObservation.h>

#include <memory>

#include "hgmm/mrpt_bridge/reading_params.h"
#include "hgmm/params.h"
#include "hgmm/scan.h"

namespace hgmm::mrpt_bridge {

/// samplesOf an observation's points, made once for all maps of the process that take it in
/// with the same parameters: particles. Null if it cannot be understood.
std::shared_ptr<const ScanSamples> sharedSamplesOf(
    const mrpt::obs::CObservation& observation, const MapParams& params,
    const ReadingParams& reading);

/// Frees them.
void forgetSharedSamples();

}  // namespace hgmm::mrpt_bridge
