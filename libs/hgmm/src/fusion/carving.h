#pragma once
#include <cstdint>
#include <vector>

#include "fusion/ray_image.h"
#include "hgmm/mixture.h"

namespace hgmm {

/// Whether a scan saw through a component: rays at its mean and at most of
/// its sigma points end more than three of its standard deviations behind it.
bool isSeenThrough(const Gaussian<3>& component, const RayImage& image);

/// Components that a scan saw through, rising.
/// @param near rows of components that may be in view, rising
std::vector<std::uint32_t> seenThrough(const Mixture<3>& surfaces, const RayImage& image,
                                       const std::vector<std::uint32_t>& near);

}  // namespace hgmm
