#include "scan/ray_image.h"

namespace hgmm {

RayImage::Bin RayImage::binOf(const Eigen::Vector3d& direction) {
    int axis = 0;
    const double largest = direction.cwiseAbs().maxCoeff(&axis);
    return {2 * axis + (direction[axis] < 0 ? 1 : 0),
            binAt(direction[(axis + 1) % 3] / largest),
            binAt(direction[(axis + 2) % 3] / largest)};
}

RayImage::RayImage(const Mixture<3>& ends, const Eigen::Vector3d& origin)
    : origin_(origin),
      first_(kAllBins + 1, 0),
      nearest_m_(kAllBins, 0.F),
      farthest_m_(kAllBins, 0.F) {
    std::vector<Ray> rays;
    std::vector<std::size_t> binOfRay;
    rays.reserve(ends.size());
    binOfRay.reserve(ends.size());
    for (std::size_t i = 0; i < ends.size(); ++i) {
        const Eigen::Vector3d ray =
            Eigen::Vector3d(ends.mean[0][i], ends.mean[1][i], ends.mean[2][i]) - origin;
        const double length = ray.norm();
        if (!(length > 0)) continue;
        const Bin place = binOf(ray);
        const std::size_t bin = numberOf(place.face, place.row, place.col);
        rays.push_back({ray / length, length});
        binOfRay.push_back(bin);
        ++first_[bin + 1];
        const auto range = static_cast<float>(length);
        if (nearest_m_[bin] == 0.F || range < nearest_m_[bin]) nearest_m_[bin] = range;
        farthest_m_[bin] = std::max(farthest_m_[bin], range);
        longest_m_ = std::max(longest_m_, length);
    }
    for (std::size_t bin = 0; bin < kAllBins; ++bin) first_[bin + 1] += first_[bin];
    std::vector<std::uint32_t> next(first_.begin(), first_.end() - 1);
    rays_.resize(rays.size());
    for (std::size_t k = 0; k < rays.size(); ++k) rays_[next[binOfRay[k]]++] = rays[k];
}

float RayImage::nearestRange(const Eigen::Vector3d& direction) const {
    const Bin bin = binOf(direction);
    float nearest = nearest_m_[numberOf(bin.face, bin.row, bin.col)];
    if (nearest == 0.F) return 0.F;
    for (int row = std::max(bin.row - 1, 0); row <= std::min(bin.row + 1, kBins - 1); ++row)
        for (int col = std::max(bin.col - 1, 0); col <= std::min(bin.col + 1, kBins - 1);
             ++col) {
            const float range = nearest_m_[numberOf(bin.face, row, col)];
            if (range > 0.F) nearest = std::min(nearest, range);
        }
    return nearest;
}

}  // namespace hgmm
