#pragma once
#include <mrpt/maps/CHGMMOccupancyMap.h>
#include <mrpt/serialization/CArchive.h>

#include <string>

#include "hgmm/mrpt_bridge/output_file.h"

/// How a map is written to MRPT archives and to files.
namespace hgmm::mrpt_bridge {

/// Version of the layout that writeMap uses; readMap knows it and all before.
constexpr std::uint8_t kArchiveVersion = 2;

/// Returns a digest of the model's bytes, as readMap does.
std::uint64_t writeMap(mrpt::serialization::CArchive& out,
                       const mrpt::maps::CHGMMOccupancyMap& map, Encoding encoding);
/// Throws std::runtime_error for a version, option or buffer that cannot be used; the map
/// is unchanged then.
std::uint64_t readMap(mrpt::serialization::CArchive& in, std::uint8_t version,
                      mrpt::maps::CHGMMOccupancyMap& map);

/// Implements CHGMMOccupancyMap::saveToFile.
void saveMapFile(const mrpt::maps::CHGMMOccupancyMap& map, const std::string& fileName,
                 Replace replace);
/// Implements CHGMMOccupancyMap::loadFromFile.
mrpt::maps::CHGMMOccupancyMap loadMapFile(const std::string& fileName);

}  // namespace hgmm::mrpt_bridge
