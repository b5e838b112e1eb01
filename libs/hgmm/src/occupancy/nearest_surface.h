#pragma once
#include <Eigen/Core>
#include <cstdint>

#include "hgmm/surface_distance.h"
#include "occupancy/patch_tree.h"

namespace hgmm {

/// Answers distance queries of one thread. Successive points that are near each other cost
/// less; answers do not depend on their order.
template <int D>
class NearestSurface {
 public:
    /// @param patches must outlive this
    NearestSurface(const PatchTree<D>& patches, double maxDistance_m)
        : patches_(patches), maxDistance_m_(maxDistance_m) {}

    SurfaceDistance operator()(const Eigen::Matrix<double, D, 1>& point);

 private:
    const PatchTree<D>& patches_;
    double maxDistance_m_;
    std::uint32_t last_ = SurfaceDistance::kNone;  ///< slot of the last answer
};

extern template class NearestSurface<2>;
extern template class NearestSurface<3>;

}  // namespace hgmm
