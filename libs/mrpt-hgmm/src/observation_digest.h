#pragma once
#include <mrpt/obs/CObservation.h>

#include <cstdint>

namespace hgmm::mrpt_bridge {

/// Tells observations at the same address apart: a hash of time stamp, sensor pose, the
/// fields that place its points, and a spread sample of its data, so that it costs
/// microseconds.
std::uint64_t digestOf(const mrpt::obs::CObservation& observation);

}  // namespace hgmm::mrpt_bridge
