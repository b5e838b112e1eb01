#include <mrpt/maps/CHGMMOccupancyMap.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "hgmm/component_index.h"

namespace mrpt::maps {

namespace {

/// The distance from a point beyond which the map holds nothing [m].
double reachFrom(const Eigen::Vector3d& from_map, const ::hgmm::Map& map) {
    const ::hgmm::Mixture<3>& surface = map.mixture();
    double reach = 0;
    for (int axis = 0; axis < 3; ++axis) {
        const auto& mean = surface.mean[axis];
        const auto& variance = surface.covariance[::hgmm::packedIndex(3, axis, axis)];
        const double from = from_map[axis] - map.origin()[axis];
        double farthest = 0;
        for (std::size_t i = 0; i < surface.size(); ++i)
            farthest = std::max(
                farthest, std::abs(mean[i] - from) +
                              ::hgmm::ComponentIndex::kSigmas * std::sqrt(variance[i]));
        reach = std::hypot(reach, farthest);
    }
    return reach;
}

}  // namespace

bool CHGMMOccupancyMap::getPointOccupancy(float x, float y, float z,
                                          double& prob_occupancy) const {
    const ::hgmm::Occupancy answer = model_.occupancy({x, y, z});
    const bool known = answer.unknown <= 0.5F;
    prob_occupancy = known ? answer.probability() : 0.5;
    return known;
}

bool CHGMMOccupancyMap::isPointWithinOctoMap(float x, float y, float z) const {
    return model_.occupancy({x, y, z}).unknown <= 0.5F;
}

bool CHGMMOccupancyMap::castRay(const mrpt::math::TPoint3D& origin,
                                const mrpt::math::TPoint3D& direction,
                                mrpt::math::TPoint3D& end, bool ignoreUnknownCells,
                                double maxRange) const {
    const Eigen::Vector3d from(origin.x, origin.y, origin.z);
    const Eigen::Vector3d along(direction.x, direction.y, direction.z);
    if (!from.allFinite())
        throw std::invalid_argument("castRay: the origin is not a finite point");
    ::hgmm::RayCastParams params;
    params.minOccupied = renderOptions.minOccupied;
    params.stopAtUnknown = !ignoreUnknownCells;
    // The map's own extent, where it ends sooner, so that no ray goes on for ever.
    params.maxRange_m = std::max(reachFrom(from, model_), 1e-3);
    if (maxRange > 0) params.maxRange_m = std::min(params.maxRange_m, maxRange);
    const auto hit = model_.castRay(from, along, params);
    if (hit) end = {hit->point_map.x(), hit->point_map.y(), hit->point_map.z()};
    return hit.has_value();
}

}  // namespace mrpt::maps
