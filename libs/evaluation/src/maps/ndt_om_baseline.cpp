#include "hgmm/evaluation/ndt_om_baseline.h"

#include <algorithm>
#include <cmath>

#include "hgmm/evaluation/voxel_traversal.h"
#include "maps/scan_points.h"

namespace hgmm::evaluation {
namespace {

constexpr double kHit = 0.6;            ///< P(occupied) after one hit of an unknown cell
constexpr double kMiss = 0.4;           ///< after one ray through its middle
constexpr double kClamping = 0.999;     ///< largest P(occupied), and of its contrary
constexpr double kMaxPoints = 1.0e4;    ///< that a cell's Gaussian remembers
constexpr double kRangeSigma_m = 0.02;  ///< noise of a range

double logOdds(double p) {
    return std::log(p / (1.0 - p));
}
double probability(double logOdds) {
    return 1.0 / (1.0 + std::exp(-logOdds));
}

float updated(float before, double change) {
    const double most = logOdds(kClamping);
    return static_cast<float>(std::clamp(before + change, -most, most));
}

/// How sure it is that a ray that ended at `end` saw a Gaussian's place empty: the
/// Gaussian's value (1 at its mean) where it is largest along the ray, less the likelihood
/// that the ray ended there.
double missEvidence(const CellGaussian& gaussian, const Eigen::Vector3d& origin_map,
                    const Eigen::Vector3d& end_map) {
    const Eigen::Vector3d ray = (end_map - origin_map).normalized();
    const Eigen::Vector3d weighted = gaussian.information * ray;
    const double depth_m = weighted.dot(gaussian.mean_map - origin_map) / weighted.dot(ray);
    const Eigen::Vector3d likeliest = origin_map + depth_m * ray;
    const double crossed = std::exp(-0.5 * gaussian.squaredDistance(likeliest));
    const double fromEnd = (end_map - likeliest).norm() / kRangeSigma_m;
    return crossed * (1.0 - std::exp(-0.5 * fromEnd * fromEnd));
}

}  // namespace

std::string NdtOmBaseline::source() const {
    return "Saarinen et al., 3D normal distributions transform occupancy maps, "
           "International Journal of Robotics Research 2013";
}

std::vector<std::pair<std::string, double>> NdtOmBaseline::options() const {
    return {{"resolution", edge_m_},
            {"probHit", kHit},
            {"probMiss", kMiss},
            {"clampingThresMin", 1.0 - kClamping},
            {"clampingThresMax", kClamping},
            {"maxPoints", kMaxPoints},
            {"rangeSigma", kRangeSigma_m}};
}

void NdtOmBaseline::insert(const Scan& scan) {
    const Eigen::Vector3d& origin_map = scan.T_map_sensor.t;
    if (!hasVoxel(origin_map, edge_m_)) return;
    for (const Eigen::Vector3d& p_map : finitePointsInMap(scan)) {
        if (!hasVoxel(p_map, edge_m_)) continue;
        const VoxelIndex voxel = voxelOf(p_map, edge_m_);
        hits_.cell(hits_.numberOf(voxel)).add(p_map - centreOf(voxel, edge_m_));
    }
    // All rays before all hits: evidence against a Gaussian is of the map before the scan.
    for (std::size_t i = 0; i < hits_.size(); ++i) {
        const PointSums& sums = hits_.cell(i);
        traceRay(origin_map, centreOf(hits_.index(i), edge_m_) + sums.mean(), sums.n);
    }
    for (std::size_t i = 0; i < hits_.size(); ++i) addHits(hits_.index(i), hits_.cell(i));
    hits_.clear();
}

void NdtOmBaseline::traceRay(const Eigen::Vector3d& origin_map,
                             const Eigen::Vector3d& end_map, double weight) {
    traverseVoxels(origin_map, end_map, edge_m_, [&](const VoxelIndex& voxel) {
        Cell& cell = cells_.cell(cells_.numberOf(voxel));
        double evidence = 1.0;
        if (cell.surface != kNoSurface && surfaces_[cell.surface].gaussian)
            evidence = missEvidence(*surfaces_[cell.surface].gaussian, origin_map, end_map);
        const double p = 0.5 + (kMiss - 0.5) * evidence;
        cell.logOdds = updated(cell.logOdds, weight * logOdds(p));
    });
}

void NdtOmBaseline::addHits(const VoxelIndex& voxel, const PointSums& sums) {
    Cell& cell = cells_.cell(cells_.numberOf(voxel));
    cell.logOdds = updated(cell.logOdds, sums.n * logOdds(kHit));
    if (cell.surface == kNoSurface) {
        cell.surface = static_cast<std::uint32_t>(surfaces_.size());
        surfaces_.emplace_back();
    }
    Surface& surface = surfaces_[cell.surface];
    surface.sums.add(sums);
    surface.sums.limit(kMaxPoints);
    surface.gaussian = gaussianOf(surface.sums, centreOf(voxel, edge_m_), edge_m_);
}

const NdtOmBaseline::Cell* NdtOmBaseline::cellAt(const Eigen::Vector3d& p_map) const {
    return hasVoxel(p_map, edge_m_) ? cells_.find(voxelOf(p_map, edge_m_)) : nullptr;
}

std::optional<double> NdtOmBaseline::cellProbability(const Eigen::Vector3d& p_map) const {
    const Cell* cell = cellAt(p_map);
    if (cell == nullptr) return std::nullopt;
    return probability(cell->logOdds);
}

void NdtOmBaseline::query(const Eigen::Vector3d* points_map, std::size_t n,
                          Answer* answers) const {
    for (std::size_t i = 0; i < n; ++i) {
        answers[i] = Answer{};
        const Cell* cell = cellAt(points_map[i]);
        if (cell == nullptr) continue;
        double odds = cell->logOdds;
        if (cell->surface != kNoSurface && surfaces_[cell->surface].gaussian) {
            const CellGaussian& gaussian = *surfaces_[cell->surface].gaussian;
            odds += gaussian.logDensityAtMean + 3.0 * std::log(edge_m_) -
                    0.5 * gaussian.squaredDistance(points_map[i]);
        }
        answers[i] = {probability(odds), false};
    }
}

std::size_t NdtOmBaseline::liveBytes() const {
    return cells_.bytes() + surfaces_.size() * sizeof(Surface) + hits_.bytes();
}

}  // namespace hgmm::evaluation
