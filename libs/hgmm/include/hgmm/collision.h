#pragma once
#include <Eigen/Core>
#include <cstdint>
#include <limits>

namespace hgmm {

/// All points within a radius of a line segment: a sphere that is swept from `from` to
/// `to`, or at rest where these are equal.
struct Capsule {
    Eigen::Vector3d from = Eigen::Vector3d::Zero();  ///< [m]
    Eigen::Vector3d to = Eigen::Vector3d::Zero();    ///< [m]
    double radius_m = 0.0;                           ///< [m], >= 0
};

struct OrientedBox {
    Eigen::Vector3d centre = Eigen::Vector3d::Zero();    ///< [m]
    Eigen::Matrix3d axes = Eigen::Matrix3d::Identity();  ///< columns: its edges' directions
    Eigen::Vector3d halfEdges = Eigen::Vector3d::Zero();  ///< along them [m], >= 0
};

/// What space that nobody has seen is taken for.
enum class UnknownSpace : std::uint8_t {
    free,     ///< only surfaces count
    occupied  ///< a body that reaches into it collides
};

struct CollisionParams {
    UnknownSpace unknown = UnknownSpace::free;
    /// Distance between the points of a body that are asked whether they are unknown [m],
    /// in [1e-3, 1e3]. Only for UnknownSpace::occupied.
    double unknownSpacing_m = 0.1;
};

/// What a body would meet.
struct Collision {
    static constexpr std::uint32_t kNone = std::numeric_limits<std::uint32_t>::max();

    /// Bound of the probability that the likeliest of the patches is in the body, in [0,
    /// 1]: the distance between both is taken as normal with the patch's standard
    /// deviation. At least 0.5 where a patch touches the body, 0 where none comes within 4
    /// standard deviations, and 1 in unknown space that counts as occupied.
    double probability = 0.0;
    /// Whose patch that is, in the level's mixture; kNone if no patch decided.
    std::uint32_t component = kNone;
    bool unknown = false;  ///< the body reaches into unknown space that counts as occupied
};

}  // namespace hgmm
