#pragma once
#include <mrpt/maps/CHGMMOccupancyMap.h>
#include <mrpt/maps/CMultiMetricMap.h>

namespace archives {

/// As MRPT copies the maps of particles.
inline mrpt::maps::CHGMMOccupancyMap::Ptr copyThroughArchive(
    const mrpt::maps::CHGMMOccupancyMap& map) {
    mrpt::maps::CMultiMetricMap original;
    original.maps.push_back(mrpt::maps::CHGMMOccupancyMap::Create(map));
    const mrpt::maps::CMultiMetricMap copy = original;
    return copy.mapByClass<mrpt::maps::CHGMMOccupancyMap>();
}

}  // namespace archives
