#pragma once
#include <cstdint>
#include <vector>

#include "fusion/oversized.h"
#include "hgmm/mixture.h"
#include "index/component_index.h"
#include "scan/ray_image.h"

namespace hgmm {

/// The rays of one scan.
struct ScanRays {
    const RayImage& image;  ///< in the frame of the surfaces
    const ThicknessLimit& limit;
    double spacing_rad;  ///< angle between neighbours [rad], >= 0
};

/// Components that a scan had a ray for and did not hit: dust, and what range noise put
/// beside a surface. Carving takes only what all rays of a direction pass; these may be
/// beside an edge that stops some of the rays, or just behind a surface.
///
/// A ray is for a component if it passes within one standard deviation of its mean, or as
/// near as half the angle to the next ray, in both cases within 3.6 degrees, and does not
/// end before it by more than a surface may be thick (ThicknessLimit).
/// @param hit rows that the scan gave support to, rising
/// @param maxSupport components of so many hits or more are not asked for [count]
/// @param index of the surfaces
/// @param near rows of components that may be in view, rising
/// @return rows, rising
std::vector<std::uint32_t> missed(const Mixture<3>& surfaces,
                                  const std::vector<std::uint32_t>& hit, float maxSupport,
                                  const ScanRays& rays, const ComponentIndex& index,
                                  const std::vector<std::uint32_t>& near);

}  // namespace hgmm
