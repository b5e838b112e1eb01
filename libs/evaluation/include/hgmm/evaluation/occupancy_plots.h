#pragma once
#include <vector>

#include "hgmm/evaluation/figures.h"
#include "hgmm/evaluation/svg_plot.h"

namespace hgmm::evaluation {

/// Receiver operating characteristics of all maps that were asked about occupancy: thick
/// against near free points, thin against uniform ones.
Plot rocPlot(const std::vector<MapFigures>& maps);

/// The same against near free points alone, the first map thick.
Plot rocNearPlot(const std::vector<MapFigures>& maps);

/// The same against uniform free points alone, of which maps mistake so few that the axis
/// is logarithmic.
Plot rocUniformPlot(const std::vector<MapFigures>& maps);

/// Share of occupied points over the probability that each map gave, hits and near free
/// points 1:1; of maps whose answers are probabilities. The diagonal is what calibrated
/// maps show.
Plot reliabilityPlot(const std::vector<MapFigures>& maps);

/// AUC against near free points over memory: the levels of maps that have some, and one
/// point for each other map.
Plot levelsPlot(const std::vector<MapFigures>& maps);

}  // namespace hgmm::evaluation
