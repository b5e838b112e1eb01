#pragma once
#include <string>

#include "hgmm/map.h"

namespace maptool {

/// The ellipsoids of a level as a binary glTF 2.0 file: one sphere, and a node for each
/// component that places it. Nodes are below one that turns the map's z to glTF's y and has
/// the map's origin [m] as `extras`: coordinates are those of the local frame, for viewers
/// have floats.
std::string gltfOf(const hgmm::Map& map, std::size_t level, double sigmas);

}  // namespace maptool
