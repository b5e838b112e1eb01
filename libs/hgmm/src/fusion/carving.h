#pragma once
#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "hgmm/mixture.h"
#include "scan/ray_image.h"

namespace hgmm {

/// Whether a scan saw through a component: rays at its mean and at most of its sigma points
/// end more than three of its standard deviations behind it; but a sheet (piece.h) on which
/// a fifth of its rays end stays, for openings tell where the others went through
/// (occupancy/openings.h). Or, unless it is a sheet: three rays or more and all but a
/// twentieth of those within a standard deviation of its mean end behind it, by what poses
/// may be off besides.
/// @param normalOfRays of a planar laser; else zero
bool isSeenThrough(const Gaussian<3>& component, const RayImage& image,
                   const Eigen::Vector3d& normalOfRays);

/// Components that a scan saw through, rising.
/// @param near rows of components that may be in view, rising
std::vector<std::uint32_t> seenThrough(const Mixture<3>& surfaces, const RayImage& image,
                                       const Eigen::Vector3d& normalOfRays,
                                       const std::vector<std::uint32_t>& near);

}  // namespace hgmm
