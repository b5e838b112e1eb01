#pragma once
#include <hgmm/map.h>

#include <string>

#include "run_slam.h"

namespace hgmm::slam_app {

/// A drawing of a run, SVG: the map's surfaces from above, upright ones dark, with the way
/// of the robot, where submaps begin, loop closures, a scale, and the run's figures.
/// @param map of the run, merged
/// @param title as of the recording
std::string reportSvg(const SlamRun& run, const Map& map, const std::string& title);

}  // namespace hgmm::slam_app
