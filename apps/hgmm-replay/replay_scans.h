#pragma once
#include <mrpt/maps/CHGMMOccupancyMap.h>

#include <memory>
#include <vector>

#include "hgmm/evaluation/figures.h"
#include "hgmm/evaluation/recording.h"
#include "hgmm/evaluation/test_points.h"
#include "options.h"

namespace replay {

/// A recording, replayed.
struct Replayed {
    std::unique_ptr<mrpt::maps::CHGMMOccupancyMap> map;
    hgmm::evaluation::Run run;
    hgmm::evaluation::TestPoints testPoints;
    std::vector<double>
        insert_ms;  ///< of each mapping scan, reading and conversion excluded
    std::vector<double> conversion_ms;  ///< observation to scan, of every scan
};

/// Inserts the mapping scans and collects the test points, until the end or Ctrl-C.
Replayed replayScans(hgmm::evaluation::Recording& recording,
                     std::unique_ptr<mrpt::maps::CHGMMOccupancyMap> map,
                     const Options& options);

}  // namespace replay
