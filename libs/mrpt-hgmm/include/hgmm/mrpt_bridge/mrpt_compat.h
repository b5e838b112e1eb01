#pragma once
#include <mrpt/maps/CMetricMap.h>
#include <mrpt/version.h>

#include <cstddef>
#include <type_traits>

/// Whether MRPT is of this release or a later one. MRPT_VERSION has two hexadecimal digits
/// a part since 2.10.2, one before, so that older releases compare as lower.
#define HGMM_MRPT_AT_LEAST(major, minor, patch) \
    (MRPT_VERSION >= (((major) << 16) | ((minor) << 8) | (patch)))

/// Maps answer for nearest neighbours and bounding boxes, map factories hand over shared
/// pointers, and a configuration with a map of an unknown type is refused.
#define HGMM_MRPT_HAS_NEAREST_NEIGHBOURS HGMM_MRPT_AT_LEAST(2, 11, 3)

#if HGMM_MRPT_HAS_NEAREST_NEIGHBOURS
#include <mrpt/maps/NearestNeighborsCapable.h>
/// `override` where MRPT declares the function.
#define HGMM_OVERRIDE_SINCE_2_11_3 override
#else
/// `override` where MRPT declares the function. MRPT 2.5 does not: it is one of our own.
#define HGMM_OVERRIDE_SINCE_2_11_3
#endif

/// What differs between MRPT 2.5 (Debian 12) and 2.14 (Debian 13).
namespace hgmm::mrpt_bridge {

#if HGMM_MRPT_HAS_NEAREST_NEIGHBOURS
/// How map factories hand over a new map.
using NewMap = mrpt::maps::CMetricMap::Ptr;
using NearestNeighboursInterface = mrpt::maps::NearestNeighborsCapable;
#else
/// How map factories hand over a new map: the caller owns it.
using NewMap = mrpt::maps::CMetricMap*;
/// Stands for MRPT's interface, which MRPT 2.5 lacks.
class NearestNeighboursInterface {
 public:
    virtual ~NearestNeighboursInterface() = default;
};
#endif

namespace compat {

// Clouds of later releases hold places and what belongs to them apart, so that there can be
// less of the latter. An int argument prefers the overloads for these releases.

template <typename XYZI, typename Cloud>
auto intensities(const Cloud& cloud, int)
    -> decltype(cloud.getPointsBufferRef_intensity()) {
    return cloud.getPointsBufferRef_intensity();
}
template <typename XYZI, typename Cloud>
auto intensities(const Cloud& cloud, long) {
    const auto* xyzi = dynamic_cast<const XYZI*>(&cloud);
    return xyzi ? &xyzi->getPointsBufferRef_intensity() : nullptr;
}

template <typename Coloured>
auto colours(const Coloured& cloud, int)
    -> decltype(cloud.getPointsBufferRef_color_R()->size()) {
    return cloud.getPointsBufferRef_color_R()->size();
}
template <typename Coloured>
std::size_t colours(const Coloured& cloud, long) {
    return cloud.size();
}

}  // namespace compat

/// Pointer to the intensities of a CPointsMap's points, nullptr if it does not hold one for
/// each. MRPT 2.5 knows intensities in one class only, CPointsMapXYZI.
template <typename XYZI, typename Cloud>
auto intensitiesOf(const Cloud& cloud) {
    const auto* all = compat::intensities<XYZI>(cloud, 0);
    return all && all->size() == cloud.size() ? all : nullptr;
}

/// Whether a CColouredPointsMap holds a colour for each of its points.
template <typename Coloured>
bool hasColours(const Coloured& cloud) {
    return compat::colours(cloud, 0) == cloud.size();
}

/// What SLAM builders hand over, a pointer in MRPT 2.5 and a reference later, as a
/// reference.
template <typename Object>
const Object& referenceTo(const Object* object) {
    return *object;
}
template <typename Object>
const Object& referenceTo(const Object& object) {
    return object;
}

/// The other way round: a reference or a pointer, as Returned is.
template <typename Returned, typename Object>
Returned returnedAs(const Object& object) {
    if constexpr (std::is_pointer_v<Returned>) {
        return &object;
    } else {
        return object;
    }
}

}  // namespace hgmm::mrpt_bridge
