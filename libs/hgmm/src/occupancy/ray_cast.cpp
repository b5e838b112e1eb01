#include <algorithm>
#include <cmath>
#include <limits>

#include "occupancy/occupancy_model.h"

namespace hgmm {

namespace {

constexpr double kFirstChunk_m = 8.0;
constexpr double kUnknownStep_m = 0.1;
constexpr double kStepsPerSigma = 4.0;
constexpr double kPrecision_m = 1e-6;

}  // namespace

std::pair<double, double> OccupancyModel::spanAlong(
    const Eigen::Vector3d& start, const Eigen::Vector3d& direction) const {
    constexpr float far = std::numeric_limits<float>::max();
    const Bounds& bounds = bounds_.get([this] {
        auto made = std::make_unique<Bounds>(Bounds{{far, far, far}, {-far, -far, -far}});
        for (const BoxCells::Box& box : boxes_)
            for (int d = 0; d < 3; ++d) {
                made->low[d] = std::min(made->low[d], box.centre[d] - box.halfExtent[d]);
                made->high[d] = std::max(made->high[d], box.centre[d] + box.halfExtent[d]);
            }
        return made;
    });
    double first = -std::numeric_limits<double>::infinity(), last = -first;
    for (int d = 0; d < 3; ++d) {
        const double low = double(bounds.low[d]) - start[d],
                     high = double(bounds.high[d]) - start[d];
        if (direction[d] == 0) {
            if (low > 0 || high < 0) return {1.0, 0.0};
            continue;
        }
        first = std::max(first, std::min(low / direction[d], high / direction[d]));
        last = std::min(last, std::max(low / direction[d], high / direction[d]));
    }
    return {first, last};
}

std::vector<OccupancyModel::Interval> OccupancyModel::intervals(
    const Eigen::Vector3d& origin, const Eigen::Vector3d& direction, double from_m,
    double to_m) const {
    std::vector<std::uint32_t> near;
    const Eigen::Vector3f start = (origin + from_m * direction).cast<float>();
    const Eigen::Vector3f along = direction.cast<float>();
    surfaces_.index.visitAlongRay(start.data(), along.data(), float(to_m - from_m),
                                  [&](std::uint32_t i) { near.push_back(i); });
    std::sort(near.begin(), near.end());
    near.erase(std::unique(near.begin(), near.end()), near.end());

    std::vector<Interval> found;
    for (const std::uint32_t i : near) {
        const Factor& w = surfaces_.index.factor(i);
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
                         std::min(to_m, nearest + kSigmas * sigma), nearest, sigma});
    }
    std::sort(found.begin(), found.end(), [](const Interval& a, const Interval& b) {
        return a.start_m != b.start_m ? a.start_m < b.start_m : a.sigma_m < b.sigma_m;
    });
    return found;
}

bool OccupancyModel::crossesUnknown(const Eigen::Vector3d& origin,
                                    const Eigen::Vector3d& direction, double to_m) const {
    for (double r = 0; r < to_m; r += kUnknownStep_m)
        if (at(origin + r * direction).unknown > 0.5F) return true;
    return false;
}

/// Where the ray meets the surface that makes it occupied within one interval. P(occ) rises
/// some sigma before a surface, so it is the component's densest point along the ray, if
/// that comes later than the first occupied point and is occupied.
std::optional<double> OccupancyModel::firstOccupied(const Eigen::Vector3d& origin,
                                                    const Eigen::Vector3d& direction,
                                                    const Interval& interval,
                                                    double minOccupied) const {
    const auto isOccupied = [&](double range) {
        return at(origin + range * direction).occupied >= minOccupied;
    };
    const double step = std::max(interval.sigma_m / kStepsPerSigma, kPrecision_m);
    double above = interval.start_m;
    while (above <= interval.end_m && !isOccupied(above)) above += step;
    if (above > interval.end_m) return std::nullopt;
    if (interval.peak_m > above && isOccupied(interval.peak_m)) return interval.peak_m;
    double below = std::max(interval.start_m, above - step);
    while (above - below > kPrecision_m) {
        const double middle = (below + above) / 2;
        (isOccupied(middle) ? above : below) = middle;
    }
    return above;
}

std::optional<RayHit> OccupancyModel::castRay(const Eigen::Vector3d& origin,
                                              const Eigen::Vector3d& direction,
                                              const RayCastParams& params) const {
    const auto [first, last] = spanAlong(origin, direction);
    const double end = std::min(params.maxRange_m, last);
    double best = std::numeric_limits<double>::infinity();
    double from = std::max(0.0, first), length = kFirstChunk_m;
    for (; from < end && std::isinf(best); from += length, length *= 2)
        for (const Interval& interval :
             intervals(origin, direction, from, std::min(end, from + length))) {
            if (interval.start_m >= best) break;
            const auto range =
                firstOccupied(origin, direction, interval, params.minOccupied);
            if (range) best = std::min(best, *range);
        }
    if (!(best <= params.maxRange_m)) return std::nullopt;
    if (params.stopAtUnknown && crossesUnknown(origin, direction, best))
        return std::nullopt;
    return RayHit{best, origin + best * direction};
}

}  // namespace hgmm
