#pragma once
#include <mrpt/obs/CObservation.h>

#include <cstdint>

namespace hgmm::mrpt_bridge {

/// How much of an observation's data is looked at.
enum class Digested {
    sample,  ///< some, spread over them: costs microseconds
    whole
};

/// Tells observations at the same address apart: a hash of time stamp, sensor pose, the
/// fields that place its points, and its data, or the names of the files that hold them.
std::uint64_t digestOf(const mrpt::obs::CObservation& observation, Digested digested);

}  // namespace hgmm::mrpt_bridge
