#pragma once
#include <mrpt/maps/CHGMMOccupancyMap.h>

#include <string>

#include "options.h"
#include "run_slam.h"

namespace hgmm::slam_app {

/// The file of the map to go on from: in a folder of an earlier run, its map.hgmm.
std::string earlierMapFile(const Options& options);

/// The map to go on from, with its options. Throws std::runtime_error naming the file if it
/// is not there, no map, or empty.
mrpt::maps::CHGMMOccupancyMap::Ptr loadEarlier(const Options& options);

/// Moves a run into the frame of the map that it goes on from, if it is found there
/// (SlamRun::continuation).
void goOnFrom(const mrpt::maps::CHGMMOccupancyMap& earlier, SlamRun& run,
              const Options& options);

/// A message for a run that was not found, or in several places.
std::string notFound(const slam::Continuation& continuation, const Options& options);

}  // namespace hgmm::slam_app
