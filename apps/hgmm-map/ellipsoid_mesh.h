#pragma once
#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <vector>

#include "hgmm/evaluation/ply.h"
#include "hgmm/gaussian.h"

namespace maptool {

/// A triangle mesh of the unit sphere, faces counter-clockwise from outside.
struct Sphere {
    std::vector<Eigen::Vector3d> vertices;
    std::vector<std::array<std::uint32_t, 3>> faces;
};
const Sphere& unitSphere();

/// The ellipsoid of a component at `sigmas`: what its semi-axes do to the unit sphere.
struct Ellipsoid {
    Eigen::Vector3d centre_local;  ///< [m]
    Eigen::Matrix3d axes;          ///< their directions, a rotation
    Eigen::Vector3d lengths;       ///< [m], >= 0
};
Ellipsoid ellipsoidOf(const hgmm::Gaussian<3>& component_local, double sigmas);

/// Appends the surface at `sigmas` of one component, as a closed mesh of 80 triangles.
void appendEllipsoid(const hgmm::Gaussian<3>& component_local,
                     const Eigen::Vector3d& origin_map, double sigmas, std::uint32_t id,
                     hgmm::evaluation::Ply& ply);

}  // namespace maptool
