#pragma once
#include <Eigen/Core>

#include "hgmm/collision.h"
#include "occupancy/surface_patch.h"

namespace hgmm {

/// Distance between a body and a patch [m]: exact where they are apart, not positive where
/// they meet. Body and patch in the same frame.
double gapTo(const Capsule& body, const SurfacePatch<3>& patch);

/// A bound: no more than the distance where they are apart, by the widest of the axes that
/// part them, and not positive where they meet.
double gapTo(const OrientedBox& body, const SurfacePatch<3>& patch);

/// Half extents of the box around a body [m].
Eigen::Vector3d reachOf(const Capsule& body);
Eigen::Vector3d reachOf(const OrientedBox& body);
Eigen::Vector3d centreOf(const Capsule& body);
Eigen::Vector3d centreOf(const OrientedBox& body);

}  // namespace hgmm
