#pragma once
#include "hgmm/slam/submap_slam.h"

namespace hgmm::slam {

/// Odometry's own covariance, and the drift that it does not know of.
UncertainPose withDrift(const UncertainPose& motion, const DriftParams& drift);

}  // namespace hgmm::slam
