#pragma once
#include <Eigen/Core>
#include <array>
#include <cmath>
#include <cstdint>
#include <optional>

#include "hgmm/mixture.h"
#include "hgmm/surface_distance.h"

namespace hgmm {

/// The flat piece of surface that a component stands for: across its thinnest axis, cut at
/// kPatchSigmas along the others. A rectangle; with D = 2, that of the horizontal marginal,
/// a line segment.
template <int D>
struct SurfacePatch {
    using Point = std::array<float, D>;

    Point mean{};                 ///< [m]
    std::array<Point, D> axes{};  ///< principal, the normal first
    Point halfEdge{};             ///< along them [m]; 0 along the normal
    float normalStd_m = 0.F;      ///< thickness [m]
    float support = 0.F;          ///< [count]
    std::uint32_t component = 0;

    /// Half extent along an axis of the frame [m].
    float reach(int d) const {
        float sum = 0.F;
        for (int a = 1; a < D; ++a) sum += halfEdge[a] * std::abs(axes[a][d]);
        return sum;
    }
};

/// The patch of component i; nothing if it is not finite.
template <int D>
std::optional<SurfacePatch<D>> patchOf(const Mixture<3>& mixture, std::uint32_t i);

extern template std::optional<SurfacePatch<2>> patchOf<2>(const Mixture<3>&, std::uint32_t);
extern template std::optional<SurfacePatch<3>> patchOf<3>(const Mixture<3>&, std::uint32_t);

}  // namespace hgmm
