#pragma once
#include <Eigen/Core>
#include <vector>

#include "hgmm/mixture.h"
#include "hgmm/scan.h"

namespace hgmm {

/// Unit normal of the plane that holds all rays of a scan, as those of a planar laser:
/// their root mean square slope to it is below 0.01 and they spread ten times as far in it.
/// Zero where there is none.
/// @param samples_sensor, clearedRays_sensor in the sensor's frame
Eigen::Vector3d normalOfRays(const Mixture<3>& samples_sensor,
                             const std::vector<ClearedRay>& clearedRays_sensor);

}  // namespace hgmm
