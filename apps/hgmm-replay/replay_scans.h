#pragma once
#include <mrpt/maps/CHGMMOccupancyMap.h>

#include <memory>
#include <string>
#include <vector>

#include "hgmm/evaluation/baseline.h"
#include "hgmm/evaluation/figures.h"
#include "hgmm/evaluation/recording.h"
#include "hgmm/evaluation/test_points.h"
#include "hgmm/evaluation/unseen_points.h"
#include "options.h"

namespace replay {

/// What inserting the mapping scans into a map has cost, scan by scan.
struct InsertionCost {
    std::vector<double> insert_ms;  ///< of each, reading and conversion excluded
    /// (mapping scans inserted, live bytes then), some 20 times over the run
    std::vector<std::pair<std::size_t, std::size_t>> liveBytes;
};

/// Another map that saw the same scans.
struct ReplayedBaseline {
    std::string name;  ///< with its resolution
    std::unique_ptr<hgmm::evaluation::Baseline> map;
    InsertionCost cost;
};

/// A recording, replayed.
struct Replayed {
    mrpt::maps::CHGMMOccupancyMap::Ptr map;
    std::vector<ReplayedBaseline> baselines;
    hgmm::evaluation::Run run;
    hgmm::evaluation::TestPoints testPoints;
    /// Of all scans, test scans as well.
    hgmm::evaluation::SeenSpace seen;
    hgmm::evaluation::UnseenPoints unseen;  ///< drawn from `seen` at the end
    hgmm::evaluation::Points input_map;     ///< some of the points of each mapping scan, to
                                            ///< be looked at [m]
    InsertionCost cost;                     ///< of `map`
    std::vector<double> conversion_ms;      ///< observation to scan, of every scan
};

/// Inserts the mapping scans, in the map, in `others` and in the baselines of `options`,
/// and collects the test points, until the end or Ctrl-C.
Replayed replayScans(hgmm::evaluation::Recording& recording,
                     mrpt::maps::CHGMMOccupancyMap::Ptr map, const Options& options,
                     std::vector<ReplayedBaseline> others = {});

}  // namespace replay
