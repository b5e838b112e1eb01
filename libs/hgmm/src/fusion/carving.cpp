#include "fusion/carving.h"

#include <Eigen/Cholesky>
#include <cmath>

namespace hgmm {

bool isSeenThrough(const Gaussian<3>& component, const RayImage& image) {
    const Eigen::Vector3d& origin = image.origin();
    const Eigen::Vector3d ray = component.mean - origin;
    const double range = ray.norm();
    if (!(range > 0)) return false;
    const Eigen::Vector3d u = ray / range;
    const Eigen::Matrix3d covariance = component.covariance;
    const double margin = 3 * std::sqrt(u.dot(covariance * u));
    const auto passes = [&](const Eigen::Vector3d& point) {
        const Eigen::Vector3d towards = point - origin;
        return image.nearestRange(towards) > towards.norm() + margin;
    };
    if (!passes(component.mean)) return false;
    // Points whose moments are the component's: mean +- sqrt(3) columns of the factor.
    const Eigen::Matrix3d L = covariance.llt().matrixL();
    int passed = 0;
    for (int axis = 0; axis < 3; ++axis)
        for (const double side : {-1.7320508, 1.7320508})
            passed += passes(component.mean + side * L.col(axis)) ? 1 : 0;
    return passed >= 4;
}

std::vector<std::uint32_t> seenThrough(const Mixture<3>& surfaces, const RayImage& image,
                                       const std::vector<std::uint32_t>& near) {
    std::vector<std::uint32_t> found;
    for (const std::uint32_t i : near)
        if (isSeenThrough(surfaces[i], image)) found.push_back(i);
    return found;
}

}  // namespace hgmm
