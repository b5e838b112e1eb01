#include "occupancy/nearest_surface.h"

#include <algorithm>
#include <cmath>

namespace hgmm {

template <int D>
double distanceVariance(const SurfacePatch<D>& patch,
                        const Eigen::Matrix<double, D, 1>& direction_axes,
                        const Eigen::Matrix<double, D, 1>& at_axes) {
    (void)at_axes;
    (void)direction_axes;
    return double(patch.normalStd_m) * double(patch.normalStd_m);
}

template <int D>
SurfaceDistance NearestSurface<D>::operator()(const Eigen::Matrix<double, D, 1>& point) {
    SurfaceDistance answer;
    answer.distance_m = maxDistance_m_;
    if (!point.allFinite()) return answer;
    typename PatchTree<D>::Point p;
    for (int d = 0; d < D; ++d) p[d] = static_cast<float>(point[d]);
    const auto nearest = patches_.nearest(p, static_cast<float>(maxDistance_m_), last_);
    if (nearest.component == SurfaceDistance::kNone) return answer;
    last_ = nearest.slot;

    const SurfacePatch<D>& patch = patches_.patch(nearest.slot);
    Eigen::Matrix<double, D, 1> away_axes, at_axes, direction;
    direction.setZero();
    for (int a = 0; a < D; ++a) {
        double along = 0;
        for (int d = 0; d < D; ++d)
            along += double(patch.axes[a][d]) * double(p[d] - patch.mean[d]);
        at_axes[a] =
            std::clamp(along, -double(patch.halfEdge[a]), double(patch.halfEdge[a]));
        away_axes[a] = along - at_axes[a];
        for (int d = 0; d < D; ++d) direction[d] += away_axes[a] * double(patch.axes[a][d]);
    }
    const double length = direction.norm();
    answer.distance_m =
        std::min(std::sqrt(double(nearest.squaredDistance_m2)), maxDistance_m_);
    if (length > 0) {
        answer.gradient.template head<D>() = direction / length;
        away_axes /= length;
    }
    answer.std_m = std::sqrt(distanceVariance<D>(patch, away_axes, at_axes));
    answer.component = nearest.component;
    answer.known = double(patch.support) >= kSurfaceSupport;
    return answer;
}

template class NearestSurface<2>;
template class NearestSurface<3>;
template double distanceVariance<2>(const SurfacePatch<2>&, const Eigen::Vector2d&,
                                    const Eigen::Vector2d&);
template double distanceVariance<3>(const SurfacePatch<3>&, const Eigen::Vector3d&,
                                    const Eigen::Vector3d&);

}  // namespace hgmm
