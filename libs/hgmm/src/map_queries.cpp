#include <cmath>
#include <limits>
#include <string>

#include "hgmm/map.h"
#include "hgmm/require.h"
#include "map_derived.h"

namespace hgmm {

namespace {

/// Points handled by one task.
constexpr std::size_t kPointsPerChunk = 256;

void requireLevel(std::size_t level, std::size_t count) {
    if (level >= count)
        throw std::out_of_range("Map: no level " + std::to_string(level) + ", only 0 to " +
                                std::to_string(count - 1));
}

}  // namespace

const Mixture<3>& Map::mixture(std::size_t level) const {
    requireLevel(level, levelCount());
    return level == 0 ? model_.surfaces : derived_->mixture(*this, level);
}

const Views& Map::views(std::size_t level) const {
    requireLevel(level, levelCount());
    return level == 0 ? model_.views : derived_->views(*this, level);
}

const Mixture<4>& Map::freeMixture(std::size_t level) const {
    requireLevel(level, levelCount());
    if (level > 0) return derived_->freeMixture(*this, level);
    return freePerComponent() ? model_.freeOfSurfaces : model_.freeSpace.mixture();
}

double Map::logDensity(const Eigen::Vector3d& point_map) const {
    if (empty()) return -std::numeric_limits<double>::infinity();
    const ComponentIndex& index = derived_->index(*this);
    const Eigen::Vector3f p = (point_map - origin_).cast<float>();
    double density = -std::numeric_limits<double>::infinity();
    index.visitCandidates(p.x(), p.y(), p.z(), [&](std::uint32_t j) {
        density = logAddExp(density, std::log(double(model_.surfaces.support[j])) +
                                         double(index.factor(j).logPdf(p.data())));
    });
    return density - derived_->logTotalSupport(*this);
}

Occupancy Map::occupancy(const Eigen::Vector3d& point_map, std::size_t level) const {
    requireLevel(level, levelCount());
    if (empty()) return {};
    return derived_->occupancy(*this, level).at(point_map - origin_);
}

void Map::occupancy(const Eigen::Vector3d* points_map, std::size_t n, Occupancy* answers,
                    std::size_t level) const {
    requireLevel(level, levelCount());
    if (empty()) {
        std::fill(answers, answers + n, Occupancy{});
        return;
    }
    const OccupancyModel& model = derived_->occupancy(*this, level);
#pragma omp parallel for schedule(dynamic)
    for (std::size_t chunk = 0; chunk < (n + kPointsPerChunk - 1) / kPointsPerChunk;
         ++chunk)
        for (std::size_t i = chunk * kPointsPerChunk;
             i < std::min(n, (chunk + 1) * kPointsPerChunk); ++i)
            answers[i] = model.at(points_map[i] - origin_);
}

Eigen::Vector3d Map::occupancyGradient(const Eigen::Vector3d& point_map,
                                       std::size_t level) const {
    requireLevel(level, levelCount());
    if (empty()) return Eigen::Vector3d::Zero();
    return derived_->occupancy(*this, level).gradient(point_map - origin_);
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
    std::optional<RayHit> hit =
        derived_->occupancy(*this, level)
            .castRay(origin_map - origin_, direction_map / length, params);
    if (hit) hit->point_map += origin_;
    return hit;
}

}  // namespace hgmm
