#pragma once
#include <string>
#include <vector>

#include "hgmm/evaluation/figures.h"

namespace replay {

/// The figures of a run for a reader: those of our map (the first), then occupancy of all
/// maps side by side.
std::string table(const hgmm::evaluation::Run& run,
                  const std::vector<hgmm::evaluation::MapFigures>& maps,
                  const hgmm::evaluation::Timing& conversion_ms);

/// The levels of our map, a line each.
std::string levelsTable(const hgmm::evaluation::MapFigures& map);

}  // namespace replay
