#pragma once
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "hgmm/evaluation/figures.h"

namespace hgmm::evaluation {

/// The figures of a run as metrics.json holds them: `dataset`, `protocol` and one entry of
/// `maps` per map. What was not measured is left out.
nlohmann::ordered_json metricsJson(const Run& run, const std::vector<MapFigures>& maps);

}  // namespace hgmm::evaluation
