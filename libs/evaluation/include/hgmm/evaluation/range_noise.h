#pragma once
#include <cstddef>
#include <cstdint>

#include "hgmm/scan.h"

namespace hgmm::evaluation {

/// Moves every point of a scan along its ray by normally distributed noise: for recordings
/// of a simulated sensor that has none. Points at the sensor's origin, or not finite, stay.
/// The same (seed, scanIndex) gives the same noise on every platform.
/// @param std_m standard deviation [m]; throws std::invalid_argument unless finite and >= 0
void addRangeNoise(Scan& scan, double std_m, std::uint64_t seed, std::size_t scanIndex);

}  // namespace hgmm::evaluation
