#pragma once
#include <Eigen/Core>
#include <cstdint>
#include <limits>

namespace hgmm {

/// A component's patch, its flat piece of surface, reaches so far from the mean along each
/// of its two wide axes [sigma]: an evenly filled rectangle has this extent.
constexpr double kPatchSigmas = 1.7320508075688772;

/// How far Map::distance looks.
struct DistanceParams {
    double maxDistance_m = 5.0;  ///< farther surfaces are not seen [m], in [1e-3, 1e6]
};

/// What a map says about the way to its nearest surface.
struct SurfaceDistance {
    static constexpr std::uint32_t kNone = std::numeric_limits<std::uint32_t>::max();

    /// Euclidean distance to the nearest point of all patches [m], >= 0. Where no patch is
    /// within maxDistance_m, it is maxDistance_m, so that the field has no step there.
    double distance_m = 0.0;
    /// Of that distance: the unit vector away from the nearest point. Zero on a patch and
    /// where there is no answer.
    Eigen::Vector3d gradient = Eigen::Vector3d::Zero();
    /// Standard deviation of the distance [m]; 0 where there is no answer.
    double std_m = 0.0;
    /// Whose patch is the nearest, in the level's mixture; kNone where there is no answer.
    std::uint32_t component = kNone;
    /// There is an answer, and as many hits are behind it as make a surface
    /// (kSurfaceSupport).
    bool known = false;

    /// Whether a patch is within maxDistance_m.
    bool answered() const { return component != kNone; }
};

/// Fewer hits may be dust or a reflection [count].
constexpr double kSurfaceSupport = 5.0;

}  // namespace hgmm
