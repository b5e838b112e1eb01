#pragma once
#include <mrpt/maps/CHGMMOccupancyMap.h>

#include <vector>

#include "dump.h"
#include "questions.h"
#include "recording.h"

namespace equality {

/// Adds what a map says as MRPT asks it: likelihoods of scans about their poses, pairs with
/// their points, occupancy, rays, distances; and its bytes as an MRPT object, with the
/// likelihoods of the object read back.
void addPluginAnswers(Dump& dump, const mrpt::maps::CHGMMOccupancyMap& map,
                      const std::vector<RecordedScan>& scans, const Questions& questions);

/// A scan of an observation's points as seen from the robot's place, without channels.
hgmm::Scan pointsOf(const RecordedScan& scan);

}  // namespace equality
