#pragma once
#include <hgmm/known_cells.h>

#include <string>
#include <vector>

namespace hgmm::importer {

/// A map of ROS' map_server.
struct RosMap {
    KnownCells cells;                ///< one layer, whose middle is at the height asked for
    std::vector<std::string> notes;  ///< what was guessed or left out
};

/// Reads the .yaml and the picture that it names (.pgm, .png, ...), as map_server does:
/// modes trinary, scale and raw, negate, thresholds, and an origin with yaw. Values between
/// the thresholds, and transparent pixels, are unknown. Throws std::runtime_error naming
/// the file if a field is missing or out of range, or the picture cannot be read.
/// @param height_m of the layer in the map frame
RosMap readRosMap(const std::string& yamlFile, double height_m);

}  // namespace hgmm::importer
