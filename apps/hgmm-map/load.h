#pragma once
#include <mrpt/maps/CHGMMOccupancyMap.h>

#include <cstddef>
#include <string>
#include <vector>

#include "hgmm/mrpt_bridge/output_file.h"

namespace maptool {

/// Reads a saved map. Throws std::runtime_error naming the file.
mrpt::maps::CHGMMOccupancyMap loadMap(const std::string& file);

/// The --force of commands.
inline hgmm::mrpt_bridge::Replace replaceFor(bool force) {
    return force ? hgmm::mrpt_bridge::Replace::anyKind
                 : hgmm::mrpt_bridge::Replace::sameKind;
}

/// A level of a map that must not be empty. Throws std::runtime_error saying which levels
/// the map has, or that it is empty.
const hgmm::Mixture<3>& levelOf(const hgmm::Map& map, std::size_t level,
                                const std::string& file);

/// The modalities that `wanted` names, as hgmm::mrpt_bridge::shownModalities understands
/// each. Throws std::runtime_error saying which the map has, if it does not have them all.
std::vector<std::string> modalitiesOf(const hgmm::Map& map,
                                      const std::vector<std::string>& wanted,
                                      const std::string& file);

}  // namespace maptool
