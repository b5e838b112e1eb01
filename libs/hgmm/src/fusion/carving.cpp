#include "fusion/carving.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

#include "hgmm/params.h"

namespace hgmm {

RangeImage::Bin RangeImage::binOf(const Eigen::Vector3d& direction) {
    int axis = 0;
    const double largest = direction.cwiseAbs().maxCoeff(&axis);
    const auto bin = [&](double v) {
        return std::clamp(static_cast<int>((v / largest + 1) * (kBins / 2.0)), 0,
                          kBins - 1);
    };
    return {2 * axis + (direction[axis] < 0 ? 1 : 0), bin(direction[(axis + 1) % 3]),
            bin(direction[(axis + 2) % 3])};
}

RangeImage::RangeImage(const Mixture<3>& samples, const Eigen::Vector3d& origin)
    : ranges_(std::size_t{6} * kBins * kBins, 0.F) {
    for (std::size_t i = 0; i < samples.size(); ++i) {
        const Eigen::Vector3d ray =
            Eigen::Vector3d(samples.mean[0][i], samples.mean[1][i], samples.mean[2][i]) -
            origin;
        const Bin bin = binOf(ray);
        float& nearest = ranges_[static_cast<std::size_t>(
            (bin.face * kBins + bin.row) * kBins + bin.col)];
        const auto range = static_cast<float>(ray.norm());
        if (nearest == 0.F || range < nearest) nearest = range;
    }
}

float RangeImage::nearestRange(const Eigen::Vector3d& direction) const {
    const Bin bin = binOf(direction);
    float nearest = at(bin.face, bin.row, bin.col);
    if (nearest == 0.F) return 0.F;
    for (int row = std::max(bin.row - 1, 0); row <= std::min(bin.row + 1, kBins - 1); ++row)
        for (int col = std::max(bin.col - 1, 0); col <= std::min(bin.col + 1, kBins - 1);
             ++col) {
            const float range = at(bin.face, row, col);
            if (range > 0.F) nearest = std::min(nearest, range);
        }
    return nearest;
}

bool isSeenThrough(const Gaussian<3>& component, const RangeImage& image,
                   const Eigen::Vector3d& origin) {
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

std::vector<std::uint32_t> seenThrough(const Mixture<3>& surfaces,
                                       const Mixture<3>& samples,
                                       const Eigen::Vector3d& sensorOrigin,
                                       const CoarseGrid& grid,
                                       const CarvingParams& params) {
    std::vector<std::uint32_t> found;
    if (params.carvedSupport == 1.0) return found;
    const RangeImage image(samples, sensorOrigin);
    Eigen::Vector3d low = sensorOrigin, high = sensorOrigin;
    for (int d = 0; d < 3; ++d) {
        const auto [least, most] =
            std::minmax_element(samples.mean[d].begin(), samples.mean[d].end());
        low[d] = std::min<double>(low[d], *least);
        high[d] = std::max<double>(high[d], *most);
    }
    for (const std::uint32_t i : grid.within(low, high))
        if (isSeenThrough(surfaces[i], image, sensorOrigin)) found.push_back(i);
    return found;
}

}  // namespace hgmm
