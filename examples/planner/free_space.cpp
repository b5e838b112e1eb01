#include "free_space.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace planner {

namespace {

/// Cost of a metre of the way that touches surfaces, beside that of its length.
constexpr double kNearness = 5.0;

}  // namespace

Eigen::AlignedBox3d FreeSpace::bounds_map() const {
    Eigen::AlignedBox3d box;
    const hgmm::Mixture<3>& surfaces = map_.mixture();
    for (std::uint32_t i = 0; i < surfaces.size(); ++i)
        box.extend(Eigen::Vector3d(map_.origin() + surfaces[i].mean));
    if (robot_.planar()) box.min().z() = box.max().z() = *robot_.plane_m;
    return box;
}

bool FreeSpace::isFree(const Eigen::Vector3d& from_map,
                       const Eigen::Vector3d& to_map) const {
    const hgmm::Capsule body{from_map, to_map, robot_.radius_m + robot_.margin_m};
    hgmm::CollisionParams params;
    params.unknownSpacing_m = robot_.unknownSpacing_m();
    // A planar laser knows nothing above and below, so that its plane is asked instead.
    if (!robot_.planar()) params.unknown = robot_.unknown;
    return map_.collision(body, params).probability <= robot_.maxProbability &&
           !(robot_.planar() && robot_.unknown == hgmm::UnknownSpace::occupied &&
             reachesUnknown(body));
}

bool FreeSpace::reachesUnknown(const hgmm::Capsule& body_map) const {
    const double spacing_m = robot_.unknownSpacing_m();
    const Eigen::Vector3d along = body_map.to - body_map.from;
    const double length = along.norm(), r = body_map.radius_m;
    const Eigen::Vector3d forward =
        length > 0 ? Eigen::Vector3d(along / length) : Eigen::Vector3d::UnitX();
    const Eigen::Vector3d left(-forward.y(), forward.x(), 0);
    for (double x = -r; x <= length + r; x += spacing_m) {
        const double beyond = x - std::clamp(x, 0.0, length);
        const double halfWidth = std::sqrt(std::max(0.0, r * r - beyond * beyond));
        for (double y = -halfWidth; y <= halfWidth; y += spacing_m)
            if (map_.occupancy(body_map.from + x * forward + y * left).unknown > 0.5F)
                return true;
    }
    return false;
}

hgmm::SurfaceDistance FreeSpace::distance(const Eigen::Vector3d& centre_map,
                                          const hgmm::DistanceParams& params) const {
    if (robot_.planar()) return map_.horizontalDistance(centre_map.head<2>(), params);
    return map_.distance(centre_map, params);
}

double FreeSpace::clearance_m(const Path& path_map) const {
    double least = std::numeric_limits<double>::infinity();
    for (const Eigen::Vector3d& place : subdivided(path_map, 0.01))
        least = std::min(least, distance(place).distance_m);
    return least;
}

double FreeSpace::nearness(double distance_m) const {
    const double share = std::max(0.0, 1 - distance_m / robot_.comfort_m);
    return kNearness * share * share;
}

double FreeSpace::nearnessSlope(double distance_m) const {
    const double share = std::max(0.0, 1 - distance_m / robot_.comfort_m);
    return -2 * kNearness * share / robot_.comfort_m;
}

double FreeSpace::nearnessCurvature(double distance_m) const {
    if (distance_m >= robot_.comfort_m) return 0;
    return 2 * kNearness / (robot_.comfort_m * robot_.comfort_m);
}

double length_m(const Path& path_map) {
    double sum = 0;
    for (std::size_t i = 1; i < path_map.size(); ++i)
        sum += (path_map[i] - path_map[i - 1]).norm();
    return sum;
}

Path subdivided(const Path& path_map, double spacing_m) {
    Path places{path_map.front()};
    for (std::size_t i = 1; i < path_map.size(); ++i) {
        const Eigen::Vector3d from = path_map[i - 1], along = path_map[i] - from;
        const double parts = std::max(1.0, std::ceil(along.norm() / spacing_m));
        for (double k = 1; k <= parts; ++k) places.push_back(from + k / parts * along);
    }
    return places;
}

}  // namespace planner
