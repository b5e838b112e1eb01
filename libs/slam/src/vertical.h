#pragma once
#include <Eigen/Core>

#include "hgmm/mixture.h"

namespace hgmm::slam {

/// Which way is up: the normal that most of floors, ceilings and other level surfaces
/// share, of those within 30 deg of the z axis. The z axis where there are few.
Eigen::Vector3d verticalOf(const Mixture<3>& surfaces);

/// The least rotation that takes the z axis there.
Eigen::Matrix3d rotationFromZ(const Eigen::Vector3d& vertical);

}  // namespace hgmm::slam
