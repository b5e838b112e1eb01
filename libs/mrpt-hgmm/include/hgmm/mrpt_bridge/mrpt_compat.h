#pragma once
#include <mrpt/maps/CMetricMap.h>
#include <mrpt/version.h>

#include <type_traits>

/// Whether maps answer for nearest neighbours and bounding boxes, and map factories hand
/// over shared pointers: MRPT 2.11.3. A part of a version takes two hexadecimal digits
/// since 2.10.2.
#define HGMM_MRPT_HAS_NEAREST_NEIGHBOURS (MRPT_VERSION >= 0x020B03)

/// What differs between MRPT 2.5 (Debian 12) and 2.14 (Debian 13).
namespace hgmm::mrpt_bridge {

#if HGMM_MRPT_HAS_NEAREST_NEIGHBOURS
/// How map factories hand over a new map.
using NewMap = mrpt::maps::CMetricMap::Ptr;
#else
/// How map factories hand over a new map: the caller owns it.
using NewMap = mrpt::maps::CMetricMap*;
#endif

/// The intensities of a CPointsMapXYZI, which later releases return by pointer.
template <typename Cloud>
const auto& intensitiesOf(const Cloud& cloud) {
    const auto& intensities = cloud.getPointsBufferRef_intensity();
    if constexpr (std::is_pointer_v<std::decay_t<decltype(intensities)>>)
        return *intensities;
    else
        return intensities;
}

}  // namespace hgmm::mrpt_bridge
