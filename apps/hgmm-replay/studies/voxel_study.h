#pragma once
#include "hgmm/evaluation/recording.h"
#include "options.h"

namespace replay {

/// Thesis fig. 3.8: the voxels of 5 cm (20 cm for lidars) that our map holds occupied, and
/// those whose centres an occupancy grid, NDT-OM and GPOctoMap do, or --baselines. Prints
/// how much of the measured surface they cover, and how many lie on it. With a report
/// folder, writes the report with a picture of each. Throws std::runtime_error naming the
/// recording if no scan was left to build or to test a map.
void voxelStudy(hgmm::evaluation::Recording& recording, const Options& options);

}  // namespace replay
