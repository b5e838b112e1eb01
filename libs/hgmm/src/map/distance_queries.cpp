#include "hgmm/map.h"
#include "hgmm/params.h"
#include "map/chunks.h"
#include "map/model.h"
#include "map/require_level.h"
#include "occupancy/nearest_surface.h"

namespace hgmm {

namespace {

void require(const DistanceParams& params, std::size_t level, std::size_t levels) {
    requireLevel(level, levels);
    requireInRange("maxDistance_m", params.maxDistance_m, 1e-3, 1e6);
}

}  // namespace

SurfaceDistance Map::distance(const Eigen::Vector3d& point_map,
                              const DistanceParams& params, std::size_t level) const {
    require(params, level, levelCount());
    return NearestSurface<3>(state_->cache.patches<3>(level),
                             params.maxDistance_m)(point_map - origin());
}

void Map::distance(const Eigen::Vector3d* points_map, std::size_t n,
                   SurfaceDistance* answers, const DistanceParams& params,
                   std::size_t level) const {
    require(params, level, levelCount());
    const PatchTree<3>& patches = state_->cache.patches<3>(level);
    forEachChunk(n, [&](std::size_t begin, std::size_t end) {
        NearestSurface<3> nearest(patches, params.maxDistance_m);
        for (std::size_t i = begin; i < end; ++i)
            answers[i] = nearest(points_map[i] - origin());
    });
}

SurfaceDistance Map::horizontalDistance(const Eigen::Vector2d& point_map,
                                        const DistanceParams& params,
                                        std::size_t level) const {
    require(params, level, levelCount());
    return NearestSurface<2>(state_->cache.patches<2>(level),
                             params.maxDistance_m)(point_map - origin().head<2>());
}

}  // namespace hgmm
