#pragma once
#include <Eigen/Core>
#include <cstddef>
#include <vector>

#include "hgmm/mixture.h"

namespace hgmm {

/// Rays that meet a surface at less than this sine of an angle graze it.
constexpr double kGrazingSine = 0.3;

/// Which samples of a scan lie on surfaces that their rays graze, as the far walls of a
/// corridor, and floors between the rings of a lidar. The next rays meet such a surface far
/// before and far behind the sample. What a scan shows of it is the pattern of its rays,
/// which moves with the sensor.
/// @param samples_sensor all samples of the scan
/// @param asked indices of those that are asked for
std::vector<bool> areGrazing(const Mixture<3>& samples_sensor,
                             const std::vector<std::size_t>& asked);

}  // namespace hgmm
