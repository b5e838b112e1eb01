#pragma once
#include <mrpt/maps/metric_map_types.h>
#include <mrpt/poses/CPose3D.h>
#include <mrpt/tfest/TMatchingPair.h>

#include <cstddef>
#include <memory>
#include <mutex>

#include "hgmm/map.h"
#include "hgmm/projection.h"

namespace hgmm::mrpt_bridge {

/// Points of another map in its own frame [m]; not owned.
struct PointsView {
    const float* x = nullptr;
    const float* y = nullptr;
    const float* z = nullptr;
    std::size_t size = 0;
};

/// Pairs the points of another map with surfaces of this one, as
/// mrpt::maps::CPointsMap pairs points with points: of every decimation-th point, the
/// projection on the most likely surface (SurfaceProjection) nearer than
/// maxDistForCorrespondence + maxAngularDistForCorrespondence * (distance to
/// angularDistPivotPoint).
///
/// In a pair, `local` is the point in the other's frame, `global` its projection in the map
/// frame, `globalIdx` the component, and errorSquareAfterTransformation their squared
/// distance, which stays exact far from the map frame's origin, where `global`, a float,
/// does not: 0.25 m at 4000 km, 1 mm within 8 km.
///
/// Keeps the surfaces until invalidate(). Const calls may come from several threads. Copies
/// share the surfaces.
class SurfaceMatching {
 public:
    SurfaceMatching() = default;
    SurfaceMatching(const SurfaceMatching& o) : SurfaceMatching() { *this = o; }
    SurfaceMatching& operator=(const SurfaceMatching& o);
    ~SurfaceMatching() = default;

    /// D = 2 pairs in the horizontal plane, whatever the heights; `global.z` is the height
    /// of the component's mean.
    ///
    /// There is one pair a point, also without onlyKeepTheClosest. With onlyUniqueRobust,
    /// only the closest is kept of points with the very same projection (the ends of a
    /// surface). Points that are not finite are left out. Results are, as MRPT's own: the
    /// share of points with a projection, and the mean (in spite of its name) of squared
    /// distances, both before onlyUniqueRobust. Both are 0 if there is no pair.
    ///
    /// Throws std::invalid_argument if decimation_other_map_points is 0 or not above
    /// offset_other_map_points.
    template <int D>
    void match(const Map& map, const PointsView& other,
               const mrpt::poses::CPose3D& T_map_other,
               const mrpt::maps::TMatchingParams& params,
               mrpt::tfest::TMatchingPairList& pairs,
               mrpt::maps::TMatchingExtraResults& results) const;

    template <int D>
    using SharedSurfaces = std::shared_ptr<const SurfaceProjection<D>>;
    /// The surfaces of a map, in its local frame; made here, if they are not yet.
    template <int D>
    SharedSurfaces<D> surfacesOf(const Map& map) const;

    /// To be called when the map has changed.
    void invalidate();

 private:
    template <int D>
    SharedSurfaces<D>& surfaces() const;

    mutable std::mutex mutex_;
    mutable SharedSurfaces<2> surfaces2D_;
    mutable SharedSurfaces<3> surfaces3D_;
};

extern template void SurfaceMatching::match<2>(const Map&, const PointsView&,
                                               const mrpt::poses::CPose3D&,
                                               const mrpt::maps::TMatchingParams&,
                                               mrpt::tfest::TMatchingPairList&,
                                               mrpt::maps::TMatchingExtraResults&) const;
extern template void SurfaceMatching::match<3>(const Map&, const PointsView&,
                                               const mrpt::poses::CPose3D&,
                                               const mrpt::maps::TMatchingParams&,
                                               mrpt::tfest::TMatchingPairList&,
                                               mrpt::maps::TMatchingExtraResults&) const;

}  // namespace hgmm::mrpt_bridge
