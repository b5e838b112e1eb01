#include "fusion/missed.h"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>

namespace hgmm {

namespace {

/// A ray farther from the direction of a component is not for it [rad]: what bounds the
/// search.
constexpr double kWidest_rad = 0.0625;

/// W v: in standard deviations of the component.
Eigen::Vector3d inSigmas(const ComponentIndex::Factor& W, const Eigen::Vector3d& v) {
    return {W.factor(0, 0) * v[0], W.factor(1, 0) * v[0] + W.factor(1, 1) * v[1],
            W.factor(2, 0) * v[0] + W.factor(2, 1) * v[1] + W.factor(2, 2) * v[2]};
}

/// Whether a ray is for a component that none hit.
bool isMissed(const Gaussian<3>& component, const ComponentIndex::Factor& W,
              const ScanRays& rays) {
    const Eigen::Vector3d towards = component.mean - rays.limit.sensorOrigin;
    const double range = towards.norm(), halfSpacing = 0.5 * rays.spacing_rad;
    if (!(range > 0)) return false;
    const Eigen::Vector3d direction = towards / range, mean = inSigmas(W, towards);
    const double extent = std::sqrt(component.covariance.trace()),
                 angle = std::min(std::max(halfSpacing, extent / range), kWidest_rad),
                 length = range - std::sqrt(rays.limit.maxVarianceAt(range));
    const auto cone = RayImage::Cone::ofSine(angle);  // the sine of a little more
    return rays.image.anyAround(direction, cone, length, [&](const RayImage::Ray& ray) {
        const double aside2 = (ray.direction - direction).squaredNorm();
        if (!(ray.length_m >= length && aside2 <= angle * angle)) return false;
        if (aside2 <= halfSpacing * halfSpacing) return true;
        const Eigen::Vector3d along = inSigmas(W, ray.direction);
        const double foot = mean.dot(along);
        return mean.squaredNorm() - foot * foot / along.squaredNorm() <= 1.0;
    });
}

}  // namespace

std::vector<std::uint32_t> missed(const Mixture<3>& surfaces,
                                  const std::vector<std::uint32_t>& hit, float maxSupport,
                                  const ScanRays& rays, const ComponentIndex& index,
                                  const std::vector<std::uint32_t>& near) {
    std::vector<std::uint32_t> found;
    for (const std::uint32_t i : near) {
        if (surfaces.support[i] >= maxSupport ||
            std::binary_search(hit.begin(), hit.end(), i))
            continue;
        if (isMissed(surfaces[i], index.factor(i), rays)) found.push_back(i);
    }
    return found;
}

}  // namespace hgmm
