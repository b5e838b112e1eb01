#pragma once
#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "hgmm/mixture.h"
#include "index/component_index.h"
#include "occupancy/coverage.h"
#include "scan/ray_image.h"

namespace hgmm {

/// Cells in which rays of a scan went through surfaces of the map.
///
/// A ray goes through a component that is a piece of a surface if it meets its plane within
/// the tile that the component stands for and ends well behind it. The cells about this
/// place in which the component is felt are marked.
/// @param near rows of components that may be in view
/// @param minSupport pieces of less are left out [count]: they go as a whole
/// (isSeenThrough)
/// @param rays of the scan, whose cells of coverage say how large cells are
Coverage passedSurfaces(const Mixture<3>& surfaces, const ComponentIndex& index,
                        const std::vector<std::uint32_t>& near, float minSupport,
                        const RayImage& image, const Coverage::Rays& rays);

}  // namespace hgmm
