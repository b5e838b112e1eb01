#pragma once
#include <functional>

#include "hgmm/evaluation/points.h"

namespace hgmm::evaluation {

/// Share of test points that the uniform floor explains.
constexpr double kOutlierRatio = 0.01;

/// How far the box of the floor reaches beyond the test points [m].
constexpr double kFloorMargin_m = 1.0;

/// Mean held-out log-likelihood of hits [nat per point],
///   mean_i log( (1 - o) p(x_i) + o / V ),  o = kOutlierRatio,
/// V the volume of the axis-aligned box of the test points grown by kFloorMargin_m on each
/// side. The floor bounds from below what one point can cost, so that a map pays for a
/// surface that it lacks but is not ruined by it; a proper density stays proper.
/// @param logDensity log p of a point in the map frame [nat]; -infinity where p = 0
/// Throws std::invalid_argument if there are no points, std::runtime_error if a log-density
/// is NaN or +infinity.
double heldOutLogLikelihood(const std::function<double(const Eigen::Vector3d&)>& logDensity,
                            const Points& hits_map);

}  // namespace hgmm::evaluation
