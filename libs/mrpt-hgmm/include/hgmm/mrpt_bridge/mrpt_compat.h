#pragma once
#include <mrpt/maps/CMetricMap.h>
#include <mrpt/version.h>

/// What differs between MRPT 2.5 (Debian 12) and later releases.
namespace hgmm::mrpt_bridge {

#if MRPT_VERSION >= 0x2B3
/// How map factories hand over a new map.
using NewMap = mrpt::maps::CMetricMap::Ptr;
#else
/// How map factories hand over a new map: the caller owns it.
using NewMap = mrpt::maps::CMetricMap*;
#endif

}  // namespace hgmm::mrpt_bridge
