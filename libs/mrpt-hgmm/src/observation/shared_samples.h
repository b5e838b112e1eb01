#pragma once
#include <mrpt/obs/CObservation.h>

#include <memory>

#include "hgmm/scan.h"

namespace hgmm::mrpt_bridge {

/// samplesOf an observation's points, made once for all maps of the process that take it in
/// with the same parameters: particles. Null if it cannot be understood.
std::shared_ptr<const ScanSamples> sharedSamplesOf(
    const mrpt::obs::CObservation& observation, const MapParams& params);

/// Frees them.
void forgetSharedSamples();

}  // namespace hgmm::mrpt_bridge
