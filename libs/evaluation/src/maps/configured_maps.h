#pragma once
#include <mrpt/maps/CMetricMap.h>

#include <memory>

#include "hgmm/evaluation/baseline.h"

namespace hgmm::evaluation {

/// The baseline that asks a map of this class, see configuredBaselines().
std::unique_ptr<Baseline> baselineOf(const mrpt::maps::CMetricMap::Ptr& map);

}  // namespace hgmm::evaluation
