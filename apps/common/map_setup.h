#pragma once
#include <mrpt/maps/CHGMMOccupancyMap.h>

#include <memory>
#include <optional>
#include <string>

namespace replay {

/// The map that a configuration file describes (its only `hgmmMap`, in whatever section),
/// or one with default options. Throws std::runtime_error naming the file if it does not
/// describe exactly one, and what the map's options throw for bad values.
mrpt::maps::CHGMMOccupancyMap::Ptr makeMap(const std::optional<std::string>& config);

}  // namespace replay
