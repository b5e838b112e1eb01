#pragma once
#include <mrpt/img/TColor.h>

#include <Eigen/Core>
#include <string>
#include <vector>

#include "hgmm/map.h"

namespace hgmm::mrpt_bridge {

/// The modalities that a colour shows: r, g and b, or a single one.
/// @param wanted "rgb", the name of a modality, or empty: rgb if the map models all three,
/// else its first
/// @return names that the map models; none if it does not model those wanted
std::vector<std::string> shownModalities(const Map& map, const std::string& wanted);

/// What a map's modalities look like at points: r, g and b as they were measured; another
/// modality from blue at the lowest to red at the highest of the answers. Opaque, and grey
/// where nothing is known.
/// @param wanted as for shownModalities
/// @param points_map [m], in the map frame
std::vector<mrpt::img::TColorf> modalityColours(
    const Map& map, const std::string& wanted,
    const std::vector<Eigen::Vector3d>& points_map);

/// From blue at `low` to red at `high`.
mrpt::img::TColorf jetColour(float value, float low, float high);

}  // namespace hgmm::mrpt_bridge
