#include <cmath>
#include <limits>
#include <vector>

#include "hgmm/map.h"
#include "hgmm/params.h"
#include "index/cell_order.h"
#include "io/coverage_codec.h"
#include "map/chunks.h"
#include "map/model.h"
#include "map/require_level.h"

namespace hgmm {

std::size_t Map::levelCount() const {
    return static_cast<std::size_t>(params().hierarchy.levels);
}

const Mixture<3>& Map::mixture(std::size_t level) const {
    requireLevel(level, levelCount());
    return level == 0 ? state_->model.components.surfaces() : state_->cache.mixture(level);
}

const ViewDirections& Map::viewDirections(std::size_t level) const {
    requireLevel(level, levelCount());
    return level == 0 ? state_->model.components.viewDirections()
                      : state_->cache.viewDirections(level);
}

const Mixture<4>& Map::freeMixture(std::size_t level) const {
    requireLevel(level, levelCount());
    if (level > 0) return state_->cache.freeMixture(level);
    return state_->model.freeSpace.mixture();
}

std::size_t Map::coverageBytes(std::size_t level) const {
    requireLevel(level, levelCount());
    const Coverage& coverage =
        level == 0 ? state_->model.coverage : state_->cache.coverage(level);
    std::vector<std::uint8_t> bytes;
    if (!coverage.empty()) encodeCoverage(coverage.pruned(), bytes);
    return bytes.size();
}

double Map::logDensity(const Eigen::Vector3d& point_map) const {
    if (empty()) return -std::numeric_limits<double>::infinity();
    const ComponentIndex& index = state_->cache.index();
    const Eigen::Vector3f p = (point_map - origin()).cast<float>();
    double density = -std::numeric_limits<double>::infinity();
    index.visitCandidates(p.x(), p.y(), p.z(), [&](std::uint32_t j) {
        density = logAddExp(
            density, std::log(double(state_->model.components.surfaces().support[j])) +
                         double(index.factor(j).logPdf(p.data())));
    });
    return density - state_->cache.logTotalSupport();
}

Occupancy Map::occupancy(const Eigen::Vector3d& point_map, std::size_t level) const {
    requireLevel(level, levelCount());
    if (state_->model.isBlank()) return {};
    return state_->cache.occupancy(level).at(point_map - origin());
}

void Map::occupancy(const Eigen::Vector3d* points_map, std::size_t n, Occupancy* answers,
                    std::size_t level) const {
    requireLevel(level, levelCount());
    if (state_->model.isBlank()) {
        std::fill(answers, answers + n, Occupancy{});
        return;
    }
    // In parts, so that memory does not follow n.
    constexpr std::size_t kAtOnce = std::size_t{1} << 20U;
    for (; n > kAtOnce; points_map += kAtOnce, answers += kAtOnce, n -= kAtOnce)
        occupancy(points_map, kAtOnce, answers, level);
    const OccupancyModel& model = state_->cache.occupancy(level);
    std::vector<Eigen::Vector3d> points(n);
    std::vector<float> x(n), y(n), z(n);
    for (std::size_t i = 0; i < n; ++i) {
        points[i] = points_map[i] - origin();
        x[i] = static_cast<float>(points[i].x());
        y[i] = static_cast<float>(points[i].y());
        z[i] = static_cast<float>(points[i].z());
    }
    const std::vector<std::uint32_t> order =
        orderOfCells(x.data(), y.data(), z.data(), n, model.smallestOctave());
    forEachChunk(n, [&](std::size_t begin, std::size_t end) {
        model.at(points.data(), order.data() + begin, end - begin, answers);
    });
}

Eigen::Vector3d Map::occupancyGradient(const Eigen::Vector3d& point_map,
                                       std::size_t level) const {
    requireLevel(level, levelCount());
    if (empty()) return Eigen::Vector3d::Zero();
    return state_->cache.occupancy(level).gradient(point_map - origin());
}

std::optional<RayHit> Map::castRay(const Eigen::Vector3d& origin_map,
                                   const Eigen::Vector3d& direction_map,
                                   const RayCastParams& params, std::size_t level) const {
    requireLevel(level, levelCount());
    requireInRange("maxRange_m", params.maxRange_m, 1e-6, 1e6);
    requireInRange("minOccupied", params.minOccupied, 1e-6, 1 - 1e-6);
    const double length = direction_map.norm();
    if (!origin_map.allFinite() || !std::isfinite(length) || !(length > 0))
        throw std::invalid_argument(
            "Map::castRay: needs a finite origin and a finite direction other than zero");
    if (empty()) return std::nullopt;
    std::optional<RayHit> hit = state_->cache.occupancy(level).castRay(
        origin_map - origin(), direction_map / length, params);
    if (hit) hit->point_map += origin();
    return hit;
}

}  // namespace hgmm
