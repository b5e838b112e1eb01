#pragma once
#include <Eigen/Core>
#include <optional>

namespace hgmm {

/// Components are felt up to this distance [sigma].
constexpr double kReachSigmas = 4.0;

/// What a map says about one point (thesis 4.3). The three probabilities sum to one.
struct Occupancy {
    float occupied = 0.F;  ///< P(occ = 1 | x), thesis eq. (4.15), in [0, 1]
    float free = 0.F;      ///< P(occ = 0 | x), thesis eq. (4.16), in [0, 1]
    float unknown = 1.F;   ///< never seen, or behind a surface, in [0, 1]

    /// E[W | x] [m]: distance to the surface along the rays that saw x, thesis eq. (4.17).
    /// Without meaning where unknown is 1; 0 there. Map::distance is the Euclidean one.
    float alongRay_m = 0.F;
    /// Var[W | x] [m^2], thesis eq. (4.18), >= 0.
    float variance_m2 = 0.F;

    /// One number for maps that have no word for the unknown: it counts half, so that a
    /// point nobody has seen says 0.5. In [0, 1].
    float probability() const { return occupied + 0.5F * unknown; }
};

/// Where a ray meets the first surface: behind the first point whose P(occ) is high enough,
/// the densest point of the component that made it so.
struct RayHit {
    double range_m = 0.0;                                 ///< from the ray's origin [m]
    Eigen::Vector3d point_map = Eigen::Vector3d::Zero();  ///< [m]
};

/// When a ray through a map ends.
struct RayCastParams {
    double maxRange_m = 100.0;   ///< [m], > 0
    double minOccupied = 0.5;    ///< P(occ) that stops it [1], in (0, 1)
    bool stopAtUnknown = false;  ///< nothing is returned where P(unknown) exceeds 0.5
};

}  // namespace hgmm
