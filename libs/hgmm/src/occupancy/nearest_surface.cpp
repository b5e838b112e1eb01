#include "occupancy/nearest_surface.h"

#include <algorithm>
#include <cmath>

namespace hgmm {

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
    Eigen::Matrix<double, D, 1> direction = Eigen::Matrix<double, D, 1>::Zero();
    for (int a = 0; a < D; ++a) {
        double along = 0;
        for (int d = 0; d < D; ++d)
            along += double(patch.axes[a][d]) * double(p[d] - patch.mean[d]);
        const double halfEdge = double(patch.halfEdge[a]),
                     beyond = along - std::clamp(along, -halfEdge, halfEdge);
        for (int d = 0; d < D; ++d) direction[d] += beyond * double(patch.axes[a][d]);
    }
    const double length = direction.norm();
    answer.distance_m =
        std::min(std::sqrt(double(nearest.squaredDistance_m2)), maxDistance_m_);
    if (length > 0) answer.gradient.template head<D>() = direction / length;
    answer.std_m = double(patch.normalStd_m);
    answer.component = nearest.component;
    answer.known = double(patch.support) >= kSurfaceSupport;
    return answer;
}

template class NearestSurface<2>;
template class NearestSurface<3>;

}  // namespace hgmm
