#pragma once
#include <string>
#include <vector>

#include "hgmm/evaluation/figures.h"

namespace replay {

/// Occupancy, memory and time of insertion, one row for each map. Where occupancy was not
/// evaluated, rows hold memory and time alone.
std::string occupancyTable(const hgmm::evaluation::Run& run,
                           const std::vector<hgmm::evaluation::MapFigures>& maps);

}  // namespace replay
