#include "scan/cleared_rays.h"

#include <algorithm>
#include <utility>

#include "scan/voxel_table.h"

namespace hgmm {

namespace {

/// Keeps the first of the rays that end in one leaf of the filter.
class ThinnedRays {
 public:
    ThinnedRays(const FilterParams& params, std::size_t rays)
        : keys_(params), leaves_(rays) {}

    void add(const ClearedRay& ray) {
        const Eigen::Vector3f end = ray.length_m * ray.direction;
        const std::uint64_t key = keys_.atAnyRange(end.x(), end.y(), end.z());
        const std::size_t known = leaves_.leaves().size();
        leaves_.find(key, end.x(), end.y(), end.z());
        if (leaves_.leaves().size() > known) rays_.push_back(ray);
    }
    bool areTooMany() const { return rays_.size() > kMaxSamples; }
    std::vector<ClearedRay> take() { return std::move(rays_); }

 private:
    struct NoSums {};

    LeafKeys keys_;
    VoxelTable<NoSums> leaves_;
    std::vector<ClearedRay> rays_;
};

/// Adds all rays, unless they are too many. Returns whether it did.
bool addRays(const Scan& scan, const FilterParams& params, ThinnedRays& thinned) {
    const auto minRange = static_cast<float>(params.minRange_m);
    const auto maxRange = static_cast<float>(params.maxRange_m);
    const auto maxRange2 = static_cast<float>(params.maxRange_m * params.maxRange_m);
    if (!(maxRange > 0.F)) return true;
    for (std::size_t i = 0; i < scan.size() && !thinned.areTooMany(); ++i) {
        const float x = scan.x[i], y = scan.y[i], z = scan.z[i];
        if (!(x * x + y * y + z * z > maxRange2)) continue;
        const Eigen::Vector3f point(x, y, z);
        if (!point.allFinite()) continue;
        thinned.add({point.cast<double>().normalized().cast<float>(), maxRange});
    }
    for (const ClearedRay& ray : scan.clearedRays) {
        if (thinned.areTooMany()) return false;
        if (ray.length_m >= minRange && ray.length_m > 0.F)
            thinned.add({ray.direction.normalized(), std::min(ray.length_m, maxRange)});
    }
    return !thinned.areTooMany();
}

}  // namespace

std::vector<ClearedRay> clearedRaysOf(const Scan& scan, const FilterParams& params) {
    for (FilterParams leaves = params;; leaves = doubled(leaves)) {
        ThinnedRays thinned(leaves, scan.clearedRays.size());
        if (addRays(scan, params, thinned)) return thinned.take();
    }
}

}  // namespace hgmm
