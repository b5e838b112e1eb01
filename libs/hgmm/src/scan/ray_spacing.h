#pragma once
#include <Eigen/Core>

#include "hgmm/mixture.h"

namespace hgmm {

/// Angle between neighbouring rays of a scan [rad]: the root of the solid angle of one ray,
/// the median over samples; where all rays lie in a plane, the angle of one in it. 0
/// without rays.
/// @param samples_sensor in the sensor's frame; their supports are rays
/// @param normalOfRays_sensor of that plane; zero where there is none
double raySpacing(const Mixture<3>& samples_sensor,
                  const Eigen::Vector3d& normalOfRays_sensor);

}  // namespace hgmm
