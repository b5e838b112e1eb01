#include <mrpt/maps/CHGMMOccupancyMap.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <limits>
#include <stdexcept>

namespace mrpt::maps {

namespace {

constexpr double kNoLimit_m = 1e6;  // the farthest that hgmm::Map looks

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
    params.maxRange_m = maxRange > 0 ? std::min(maxRange, kNoLimit_m) : kNoLimit_m;
    const auto hit = model_.castRay(from, along, params);
    if (hit) end = {hit->point_map.x(), hit->point_map.y(), hit->point_map.z()};
    return hit.has_value();
}

bool CHGMMOccupancyMap::getDistanceToSurface(const mrpt::math::TPoint3D& point,
                                             double& distance,
                                             mrpt::math::TVector3D& gradient,
                                             double& stdDev, double maxDistance) const {
    const ::hgmm::SurfaceDistance answer =
        model_.distance({point.x, point.y, point.z}, {maxDistance});
    distance = answer.distance_m;
    gradient = {answer.gradient.x(), answer.gradient.y(), answer.gradient.z()};
    stdDev = answer.std_m;
    return answer.known;
}

bool CHGMMOccupancyMap::getDistanceToSurface(const mrpt::math::TPoint3D& point,
                                             double& distance, double maxDistance) const {
    mrpt::math::TVector3D gradient;
    double stdDev = 0;
    return getDistanceToSurface(point, distance, gradient, stdDev, maxDistance);
}

float CHGMMOccupancyMap::squareDistanceToClosestCorrespondence(float x0, float y0) const {
    const ::hgmm::SurfaceDistance answer =
        model_.horizontalDistance({x0, y0}, {kNoLimit_m});
    if (!answer.answered()) return std::numeric_limits<float>::infinity();
    return static_cast<float>(answer.distance_m * answer.distance_m);
}

}  // namespace mrpt::maps
