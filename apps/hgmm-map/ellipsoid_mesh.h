#pragma once
#include <Eigen/Core>

#include "hgmm/gaussian.h"
#include "ply.h"

namespace maptool {

/// Appends the surface at `sigmas` of one component, as a closed mesh of 80 triangles.
void appendEllipsoid(const hgmm::Gaussian<3>& component_local,
                     const Eigen::Vector3d& origin_map, double sigmas, std::uint32_t id,
                     Ply& ply);

}  // namespace maptool
