#pragma once
#include <mrpt/maps/CHGMMOccupancyMap.h>

#include "options.h"
#include "run_slam.h"

namespace hgmm::slam_app {

/// Files that cannot be written at the end of a long run had better be known at its start:
/// makes the folder, and throws std::runtime_error if a file cannot be written or would
/// replace an input or what is no such file.
void prepareOutputs(const Options& options);

/// Writes map.hgmm, and trajectory.tum, graph.g2o, keyframes.simplemap and report.svg, all
/// or none, if the map could be written.
/// @param map empty, with the options that it is to have
void writeOutputs(const SlamRun& run, mrpt::maps::CHGMMOccupancyMap& map,
                  const evaluation::RecordingOptions& recording, const Options& options);

}  // namespace hgmm::slam_app
