#include "fusion/missed.h"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <utility>

#include "base/lattice.h"
#include "base/lattice_table.h"

namespace hgmm {

namespace {

/// A ray farther from the direction of a component is not for it [rad]: what bounds the
/// search.
constexpr double kWidest_rad = 0.0625;

/// Rays by their directions, as points of the unit sphere in a lattice.
class RaysByDirection {
 public:
    RaysByDirection(const Mixture<3>& ends, const Eigen::Vector3d& origin) {
        rays_.reserve(ends.size());
        for (std::size_t i = 0; i < ends.size(); ++i) {
            const Eigen::Vector3d ray =
                Eigen::Vector3d(ends.mean[0][i], ends.mean[1][i], ends.mean[2][i]) - origin;
            const double length = ray.norm();
            if (!(length > 0)) continue;
            const auto row = static_cast<std::uint32_t>(rays_.size());
            rays_.push_back({ray / length, length, kNone});
            const auto [first, isNew] =
                first_.tryEmplace(LatticeCell::at(rays_.back().direction, kOctave), row);
            if (!isNew) rays_.back().next = std::exchange(*first, row);
            longest_ = std::max(longest_, length);
        }
    }

    double longest() const { return longest_; }  ///< [m]

    /// Whether isFor(ray) holds of the direction of a ray of at least `length_m` that is
    /// within `angle_rad` of another direction.
    template <typename IsFor>
    bool any(const Eigen::Vector3d& direction, double angle_rad, double length_m,
             const IsFor& isFor) const {
        const Eigen::Vector3d reach = Eigen::Vector3d::Constant(angle_rad);
        const LatticeCell low = LatticeCell::at(direction - reach, kOctave),
                          high = LatticeCell::at(direction + reach, kOctave);
        LatticeCell cell = low;
        for (cell.x = low.x; cell.x <= high.x; ++cell.x)
            for (cell.y = low.y; cell.y <= high.y; ++cell.y)
                for (cell.z = low.z; cell.z <= high.z; ++cell.z) {
                    const std::uint32_t* first = first_.find(cell);
                    for (std::uint32_t k = first == nullptr ? kNone : *first; k != kNone;
                         k = rays_[k].next) {
                        const Ray& ray = rays_[k];
                        if (ray.length >= length_m &&
                            (ray.direction - direction).squaredNorm() <=
                                angle_rad * angle_rad &&
                            isFor(ray.direction))
                            return true;
                    }
                }
        return false;
    }

 private:
    static constexpr int kOctave = -5;  // 1.8 degrees
    static constexpr std::uint32_t kNone = 0xFFFFFFFF;
    struct Ray {
        Eigen::Vector3d direction;
        double length;       ///< [m]
        std::uint32_t next;  ///< in its cell
    };

    std::vector<Ray> rays_;
    LatticeTable<std::uint32_t> first_;  ///< of each cell
    double longest_ = 0.0;
};

/// W v: in standard deviations of the component.
Eigen::Vector3d inSigmas(const ComponentIndex::Factor& W, const Eigen::Vector3d& v) {
    return {W.factor(0, 0) * v[0], W.factor(1, 0) * v[0] + W.factor(1, 1) * v[1],
            W.factor(2, 0) * v[0] + W.factor(2, 1) * v[1] + W.factor(2, 2) * v[2]};
}

/// Whether a ray is for a component that none hit.
bool isMissed(const Gaussian<3>& component, const ComponentIndex::Factor& W,
              const ScanRays& rays, const RaysByDirection& byDirection) {
    const Eigen::Vector3d towards = component.mean - rays.limit.sensorOrigin;
    const double range = towards.norm(), halfSpacing = 0.5 * rays.spacing_rad;
    if (!(range > 0)) return false;
    const Eigen::Vector3d direction = towards / range, mean = inSigmas(W, towards);
    const auto isFor = [&](const Eigen::Vector3d& ray) {
        if ((ray - direction).squaredNorm() <= halfSpacing * halfSpacing) return true;
        const Eigen::Vector3d along = inSigmas(W, ray);
        const double foot = mean.dot(along);
        return mean.squaredNorm() - foot * foot / along.squaredNorm() <= 1.0;
    };
    const double extent = std::sqrt(component.covariance.trace());
    return byDirection.any(direction,
                           std::min(std::max(halfSpacing, extent / range), kWidest_rad),
                           range - std::sqrt(rays.limit.maxVarianceAt(range)), isFor);
}

}  // namespace

std::vector<std::uint32_t> missed(const Mixture<3>& surfaces,
                                  const std::vector<std::uint32_t>& hit, float maxSupport,
                                  const ScanRays& rays, const ComponentIndex& index,
                                  const CoarseGrid& grid) {
    const Eigen::Vector3d& origin = rays.limit.sensorOrigin;
    const RaysByDirection byDirection(rays.ends, origin);
    const double around = std::sqrt(rays.limit.maxVarianceAt(byDirection.longest()));
    Eigen::Vector3d low = origin, high = origin;
    for (int d = 0; d < 3; ++d) {
        const auto [least, most] =
            std::minmax_element(rays.ends.mean[d].begin(), rays.ends.mean[d].end());
        low[d] = std::min<double>(low[d], *least) - around;
        high[d] = std::max<double>(high[d], *most) + around;
    }
    std::vector<std::uint32_t> found;
    for (const std::uint32_t i : grid.within(low, high)) {
        if (surfaces.support[i] >= maxSupport ||
            std::binary_search(hit.begin(), hit.end(), i))
            continue;
        if (isMissed(surfaces[i], index.factor(i), rays, byDirection)) found.push_back(i);
    }
    return found;
}

}  // namespace hgmm
