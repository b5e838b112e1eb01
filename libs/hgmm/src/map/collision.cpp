#include "hgmm/collision.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "hgmm/map.h"
#include "hgmm/params.h"
#include "map/model.h"
#include "map/require_level.h"
#include "occupancy/body_gap.h"

namespace hgmm {

namespace {

/// Farther patches do not count [standard deviations].
constexpr float kReachStds = 4.F;

/// More points of a body are not asked whether they are unknown.
constexpr double kMaxPoints = 1e7;

void require(const Capsule& body) {
    if (!body.from.allFinite() || !body.to.allFinite() || !std::isfinite(body.radius_m) ||
        body.radius_m < 0)
        throw std::invalid_argument(
            "Map::collision: a capsule needs finite ends and a finite radius >= 0");
}

void require(const OrientedBox& body) {
    if (!body.centre.allFinite() || !body.halfEdges.allFinite() ||
        (body.halfEdges.array() < 0).any())
        throw std::invalid_argument(
            "Map::collision: a box needs a finite centre and finite half edges >= 0");
    if (!(body.axes.transpose() * body.axes).isIdentity(1e-6))
        throw std::invalid_argument(
            "Map::collision: the axes of a box must be orthonormal");
}

Capsule moved(const Capsule& body, const Eigen::Vector3d& by) {
    return {body.from + by, body.to + by, body.radius_m};
}
OrientedBox moved(const OrientedBox& body, const Eigen::Vector3d& by) {
    return {body.centre + by, body.axes, body.halfEdges};
}

bool contains(const Capsule& body, const Eigen::Vector3d& p) {
    const Eigen::Vector3d along = body.to - body.from;
    const double length2 = along.squaredNorm();
    const double share =
        length2 > 0 ? std::clamp((p - body.from).dot(along) / length2, 0.0, 1.0) : 0.0;
    return (p - body.from - share * along).norm() <= body.radius_m;
}
bool contains(const OrientedBox& body, const Eigen::Vector3d& p) {
    return ((body.axes.transpose() * (p - body.centre)).cwiseAbs().array() <=
            body.halfEdges.array())
        .all();
}

/// P(v < 0) of a normal v with mean `gap_m`. A patch without thickness is met or not.
double probabilityOf(double gap_m, double std_m) {
    if (!(std_m > 0)) return gap_m <= 0 ? 1.0 : 0.0;
    return 0.5 * std::erfc(gap_m / (std_m * std::sqrt(2.0)));
}

/// Of surfaces alone. The body in the local frame.
template <typename Body>
Collision withPatches(const Body& body, const PatchTree<3>& patches) {
    const Eigen::Vector3d centre = centreOf(body), reach = reachOf(body);
    PatchTree<3>::Point low{}, high{};
    for (int d = 0; d < 3; ++d) {
        // Rounded outwards.
        low[d] = std::nextafter(static_cast<float>(centre[d] - reach[d]), -1e30F);
        high[d] = std::nextafter(static_cast<float>(centre[d] + reach[d]), 1e30F);
    }
    Collision found;
    patches.visitBox(low, high, kReachStds, [&](const SurfacePatch<3>& patch) {
        const double std_m = double(patch.normalStd_m), gap_m = gapTo(body, patch);
        if (gap_m > double(kReachStds) * std_m) return;
        const double probability = probabilityOf(gap_m, std_m);
        if (probability < found.probability ||
            (probability == found.probability && patch.component >= found.component))
            return;
        found.probability = probability;
        found.component = patch.component;
    });
    return found;
}

/// Whether a point of a grid over the body, its centre among them, is unknown. The body in
/// the map frame.
template <typename Body>
bool reachesUnknown(const Body& body, double spacing_m, const Map& map, std::size_t level) {
    const Eigen::Vector3d centre = centreOf(body), reach = reachOf(body);
    const Eigen::Vector3d steps = (reach / spacing_m).array().floor();
    if ((2 * steps.array() + 1).prod() > kMaxPoints)
        throw std::invalid_argument(
            "Map::collision: unknownSpacing_m is too small for so large a body");
    for (double x = -steps.x(); x <= steps.x(); ++x)
        for (double y = -steps.y(); y <= steps.y(); ++y)
            for (double z = -steps.z(); z <= steps.z(); ++z) {
                const Eigen::Vector3d p = centre + spacing_m * Eigen::Vector3d(x, y, z);
                if (contains(body, p) && map.occupancy(p, level).unknown > 0.5F)
                    return true;
            }
    return map.occupancy(centre, level).unknown > 0.5F;
}

template <typename Body>
Collision collisionOf(const Map& map, const PatchTree<3>& patches, const Body& body_map,
                      const CollisionParams& params, std::size_t level) {
    const Body local = moved(body_map, -map.origin());
    Collision found = withPatches(local, patches);
    if (params.unknown == UnknownSpace::occupied &&
        reachesUnknown(body_map, params.unknownSpacing_m, map, level)) {
        found.unknown = true;
        found.probability = 1.0;
        found.component = Collision::kNone;
    }
    return found;
}

}  // namespace

Collision Map::collision(const Capsule& body_map, const CollisionParams& params,
                         std::size_t level) const {
    requireLevel(level, levelCount());
    requireInRange("unknownSpacing_m", params.unknownSpacing_m, 1e-3, 1e3);
    require(body_map);
    return collisionOf(*this, state_->cache.patches<3>(level), body_map, params, level);
}

Collision Map::collision(const OrientedBox& body_map, const CollisionParams& params,
                         std::size_t level) const {
    requireLevel(level, levelCount());
    requireInRange("unknownSpacing_m", params.unknownSpacing_m, 1e-3, 1e3);
    require(body_map);
    return collisionOf(*this, state_->cache.patches<3>(level), body_map, params, level);
}

}  // namespace hgmm
