#pragma once
#include <Eigen/Core>

#include "hgmm/export.h"
#include "hgmm/mixture.h"
#include "hgmm/view_directions.h"

namespace hgmm {

/// The four-dimensional Gaussian over place and distance, (X, W), of a surface component
/// with a band (thesis 4.1.3): w is 0 with probability 1 - freeShare and even in (0,
/// width_m) else, and x = s + w u with s from the surface. Support counts hits and free
/// points. Conditioning on W = 0, thesis eq. (4.11) and (4.12), gives back the surface's
/// mean and covariance exactly.
HGMM_EXPORT Gaussian<4> augmented(const Gaussian<3>& surface, const ViewDirection& view,
                                  double width_m, double freeShare);

/// Space that rays passed on the way to hits, in closed form: distances w in [from_m, to_m]
/// along the rays from the points of `hits` (their mean and covariance) to `sensorOrigin`,
/// each distance equally likely (thesis 4.2.1 without sampling). The bundle narrows towards
/// the sensor. Support is that of the hits.
HGMM_EXPORT Gaussian<4> raySegmentMoments(const Gaussian<3>& hits,
                                          const Eigen::Vector3d& sensorOrigin,
                                          double from_m, double to_m);

}  // namespace hgmm
