#include <algorithm>
#include <cmath>

#include "hgmm/occupancy_model.h"

namespace hgmm {

namespace {

constexpr double kFirstChunk_m = 8.0;
constexpr double kUnknownStep_m = 0.1;
constexpr double kSigmas = 4.0;
constexpr int kBisections = 20;
constexpr double kStepsPerSigma = 4.0;

/// Where a ray that enters an occupied stretch at `entry_m` meets the surface: P(occ) rises
/// some sigma before it, so the component's densest point along the ray is taken, if that
/// comes later and is occupied.
template <typename Interval, typename Occupied>
double surfaceBehind(const Interval& interval, double from_m, double entry_m,
                     Occupied&& occupied) {
    const double halfLength = kSigmas * kStepsPerSigma * interval.step_m;
    const double peak = interval.start_m > from_m ? interval.start_m + halfLength
                                                  : interval.end_m - halfLength;
    return peak > entry_m && occupied(peak) ? peak : entry_m;
}

}  // namespace

std::vector<OccupancyModel::Interval> OccupancyModel::intervals(
    const Eigen::Vector3d& origin, const Eigen::Vector3d& direction, double from_m,
    double to_m) const {
    std::vector<std::uint32_t> near;
    const Eigen::Vector3f start = (origin + from_m * direction).cast<float>();
    const Eigen::Vector3f along = direction.cast<float>();
    surfaceBoxes_.visitAlongRay(start.data(), along.data(), float(to_m - from_m),
                                [&](std::uint32_t i) { near.push_back(i); });
    std::sort(near.begin(), near.end());
    near.erase(std::unique(near.begin(), near.end()), near.end());

    std::vector<Interval> found;
    for (const std::uint32_t i : near) {
        const WhitenedGaussian<3, float>& w = bands_[i].whitened;
        double dd = 0, od = 0, oo = 0;
        for (int row = 0; row < 3; ++row) {
            double d = 0, o = 0;
            for (int col = 0; col <= row; ++col) {
                d += double(w.factor(row, col)) * direction[col];
                o += double(w.factor(row, col)) * (origin[col] - double(w.mean(col)));
            }
            dd += d * d, od += o * d, oo += o * o;
        }
        const double nearest = -od / dd, sigma = 1 / std::sqrt(dd);
        if (oo - od * od / dd > kSigmas * kSigmas) continue;
        found.push_back({std::max(from_m, nearest - kSigmas * sigma),
                         std::min(to_m, nearest + kSigmas * sigma),
                         sigma / kStepsPerSigma});
    }
    std::sort(found.begin(), found.end(), [](const Interval& a, const Interval& b) {
        return a.start_m != b.start_m ? a.start_m < b.start_m : a.step_m < b.step_m;
    });
    return found;
}

bool OccupancyModel::crossesUnknown(const Eigen::Vector3d& origin,
                                    const Eigen::Vector3d& direction, double to_m) const {
    for (double r = 0; r < to_m; r += kUnknownStep_m)
        if (at(origin + r * direction).unknown > 0.5F) return true;
    return false;
}

std::optional<RayHit> OccupancyModel::castRay(const Eigen::Vector3d& origin,
                                              const Eigen::Vector3d& direction,
                                              const RayCastParams& params) const {
    double best = std::numeric_limits<double>::infinity();
    double from = 0, length = kFirstChunk_m;
    for (; from < params.maxRange_m && std::isinf(best); from += length, length *= 2) {
        const double to = std::min(params.maxRange_m, from + length);
        for (const Interval& interval : intervals(origin, direction, from, to)) {
            if (interval.start_m >= best) break;
            double below = interval.start_m;
            for (double r = interval.start_m; r <= std::min(interval.end_m, best);
                 r += interval.step_m) {
                if (occupiedAt(origin + r * direction) < params.minOccupied) {
                    below = r;
                    continue;
                }
                double above = r;
                for (int b = 0; b < kBisections && above - below > 1e-6; ++b) {
                    const double middle = (below + above) / 2;
                    (occupiedAt(origin + middle * direction) < params.minOccupied ? below
                                                                                  : above) =
                        middle;
                }
                best = surfaceBehind(interval, from, above, [&](double range) {
                    return occupiedAt(origin + range * direction) >= params.minOccupied;
                });
                break;
            }
        }
    }
    if (std::isinf(best)) return std::nullopt;
    if (params.stopAtUnknown && crossesUnknown(origin, direction, best))
        return std::nullopt;
    return RayHit{best, origin + best * direction};
}

}  // namespace hgmm
