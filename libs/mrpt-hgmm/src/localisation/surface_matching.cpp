#include "localisation/surface_matching.h"

#include <algorithm>
#include <stdexcept>
#include <tuple>
#include <type_traits>
#include <utility>

#include "hgmm/mrpt_bridge/observation_to_scan.h"

namespace hgmm::mrpt_bridge {

namespace {

void requireStride(const mrpt::maps::TMatchingParams& params) {
    if (params.decimation_other_map_points == 0)
        throw std::invalid_argument("decimation_other_map_points = 0: must be at least 1");
    if (params.offset_other_map_points >= params.decimation_other_map_points)
        throw std::invalid_argument(
            "offset_other_map_points = " + std::to_string(params.offset_other_map_points) +
            ": must be below decimation_other_map_points");
}

/// Of pairs with the same projection, leaves the closest, and the first of equals.
void keepClosestOfSameProjection(mrpt::tfest::TMatchingPairList& pairs) {
    const auto projection = [](const mrpt::tfest::TMatchingPair& p) {
        return std::make_tuple(p.globalIdx, float{p.global.x}, float{p.global.y},
                               float{p.global.z});
    };
    const auto rank = [&](const mrpt::tfest::TMatchingPair& p) {
        return std::tuple_cat(
            projection(p),
            std::make_tuple(float{p.errorSquareAfterTransformation}, p.localIdx));
    };
    std::sort(pairs.begin(), pairs.end(),
              [&](const auto& a, const auto& b) { return rank(a) < rank(b); });
    pairs.erase(std::unique(pairs.begin(), pairs.end(),
                            [&](const auto& a, const auto& b) {
                                return projection(a) == projection(b);
                            }),
                pairs.end());
    std::sort(pairs.begin(), pairs.end(),
              [](const auto& a, const auto& b) { return a.localIdx < b.localIdx; });
}

/// Up to which distance a point is matched [m].
template <int D>
float reach(const mrpt::maps::TMatchingParams& params, const Eigen::Vector3d& p_map) {
    if (params.maxAngularDistForCorrespondence == 0) return params.maxDistForCorrespondence;
    const auto& pivot = params.angularDistPivotPoint;
    const Eigen::Vector3d arm = p_map - Eigen::Vector3d(pivot.x, pivot.y, pivot.z);
    return params.maxDistForCorrespondence +
           params.maxAngularDistForCorrespondence *
               static_cast<float>(arm.template head<D>().norm());
}

}  // namespace

SurfaceMatching& SurfaceMatching::operator=(const SurfaceMatching& o) {
    if (this == &o) return *this;
    const std::scoped_lock lock(mutex_, o.mutex_);
    surfaces2D_ = o.surfaces2D_;
    surfaces3D_ = o.surfaces3D_;
    return *this;
}

template <int D>
SurfaceMatching::SharedSurfaces<D>& SurfaceMatching::surfaces() const {
    if constexpr (D == 2)
        return surfaces2D_;
    else
        return surfaces3D_;
}

template <int D>
SurfaceMatching::SharedSurfaces<D> SurfaceMatching::surfacesOf(const Map& map) const {
    const std::lock_guard<std::mutex> lock(mutex_);
    auto& kept = surfaces<D>();
    if (!kept) kept = std::make_shared<const SurfaceProjection<D>>(map.mixture());
    return kept;
}

template SurfaceMatching::SharedSurfaces<2> SurfaceMatching::surfacesOf<2>(
    const Map&) const;
template SurfaceMatching::SharedSurfaces<3> SurfaceMatching::surfacesOf<3>(
    const Map&) const;

template <int D>
void SurfaceMatching::match(const Map& map, const PointsView& other,
                            const mrpt::poses::CPose3D& T_map_other,
                            const mrpt::maps::TMatchingParams& params,
                            mrpt::tfest::TMatchingPairList& pairs,
                            mrpt::maps::TMatchingExtraResults& results) const {
    requireStride(params);
    pairs.clear();
    results = {};
    if (map.empty() || other.size == 0) return;
    const auto surfaces = surfacesOf<D>(map);
    const Pose T = toPose(T_map_other);
    std::size_t considered = 0;
    double sum_m2 = 0;
    for (std::size_t i = params.offset_other_map_points; i < other.size;
         i += params.decimation_other_map_points) {
        const Eigen::Vector3d p_map =
            T.R * Eigen::Vector3d(other.x[i], other.y[i], other.z[i]) + T.t;
        if (!p_map.allFinite()) continue;
        ++considered;
        typename SurfaceProjection<D>::Point local;
        for (int d = 0; d < D; ++d)
            local[d] = static_cast<float>(p_map[d] - map.origin()[d]);
        const auto projection = surfaces->mostLikely(local, reach<D>(params, p_map));
        if (!projection) continue;
        Eigen::Vector3d projection_map = map.origin();
        for (int d = 0; d < D; ++d) projection_map[d] += double(projection->point[d]);
        if (D == 2)
            projection_map.z() += double(map.mixture().mean[2][projection->component]);
        pairs.emplace_back(
            projection->component, static_cast<std::uint32_t>(i),
            static_cast<float>(projection_map.x()), static_cast<float>(projection_map.y()),
            static_cast<float>(projection_map.z()), other.x[i], other.y[i], other.z[i]);
        pairs.back().errorSquareAfterTransformation = projection->squaredDistance_m2;
        sum_m2 += double(projection->squaredDistance_m2);
    }
    if (pairs.empty()) return;
    results.correspondencesRatio =
        static_cast<float>(double(pairs.size()) / double(considered));
    results.sumSqrDist = static_cast<float>(sum_m2 / double(pairs.size()));
    if (params.onlyUniqueRobust) keepClosestOfSameProjection(pairs);
}

template void SurfaceMatching::match<2>(const Map&, const PointsView&,
                                        const mrpt::poses::CPose3D&,
                                        const mrpt::maps::TMatchingParams&,
                                        mrpt::tfest::TMatchingPairList&,
                                        mrpt::maps::TMatchingExtraResults&) const;
template void SurfaceMatching::match<3>(const Map&, const PointsView&,
                                        const mrpt::poses::CPose3D&,
                                        const mrpt::maps::TMatchingParams&,
                                        mrpt::tfest::TMatchingPairList&,
                                        mrpt::maps::TMatchingExtraResults&) const;

void SurfaceMatching::invalidate() {
    const std::lock_guard<std::mutex> lock(mutex_);
    surfaces2D_.reset();
    surfaces3D_.reset();
}

}  // namespace hgmm::mrpt_bridge
