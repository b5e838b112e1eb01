#pragma once
#include <mrpt/maps/CHGMMOccupancyMap.h>

#include <memory>
#include <string>
#include <vector>

#include "hgmm/evaluation/baseline.h"
#include "hgmm/evaluation/figures.h"
#include "hgmm/evaluation/recording.h"
#include "hgmm/evaluation/test_points.h"
#include "options.h"

namespace replay {

/// Another map that saw the same scans.
struct ReplayedBaseline {
    std::string name;  ///< as given to makeBaseline
    std::unique_ptr<hgmm::evaluation::Baseline> map;
    std::vector<double> insert_ms;  ///< of each mapping scan
};

/// A recording, replayed.
struct Replayed {
    std::unique_ptr<mrpt::maps::CHGMMOccupancyMap> map;
    std::vector<ReplayedBaseline> baselines;
    hgmm::evaluation::Run run;
    hgmm::evaluation::TestPoints testPoints;
    std::vector<double>
        insert_ms;  ///< of each mapping scan, reading and conversion excluded
    std::vector<double> conversion_ms;  ///< observation to scan, of every scan
};

/// Inserts the mapping scans, in the map and in baselines, and collects the test points,
/// until the end or Ctrl-C.
Replayed replayScans(hgmm::evaluation::Recording& recording,
                     std::unique_ptr<mrpt::maps::CHGMMOccupancyMap> map,
                     const Options& options);

}  // namespace replay
