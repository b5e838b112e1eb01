#pragma once
#include <vector>

#include "hgmm/evaluation/figures.h"
#include "hgmm/evaluation/svg_plot.h"

namespace hgmm::evaluation {

/// Time to insert each mapping scan [ms], over their number, in order. Of runs too long to
/// draw each scan it shows medians of consecutive ones, and its axis says of how many.
Plot insertionPlot(const std::vector<MapFigures>& maps);

/// Live memory [KB] over the mapping scans inserted.
Plot memoryPlot(const std::vector<MapFigures>& maps);

}  // namespace hgmm::evaluation
