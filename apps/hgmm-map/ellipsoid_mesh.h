#pragma once
#include <Eigen/Core>

#include "hgmm/evaluation/ply.h"
#include "hgmm/gaussian.h"

namespace maptool {

/// Appends the surface at `sigmas` of one component, as a closed mesh of 80 triangles.
void appendEllipsoid(const hgmm::Gaussian<3>& component_local,
                     const Eigen::Vector3d& origin_map, double sigmas, std::uint32_t id,
                     hgmm::evaluation::Ply& ply);

}  // namespace maptool
