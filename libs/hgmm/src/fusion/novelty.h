#pragma once
#include <cstddef>
#include <cstdint>
#include <vector>

#include "fusion/oversized.h"
#include "hgmm/em.h"
#include "hgmm/mixture.h"
#include "hgmm/view_directions.h"
#include "index/component_index.h"

namespace hgmm {

struct NoveltySplit {
    std::vector<std::uint32_t> novel;  ///< sample indices, rising
    std::vector<std::uint32_t> known;  ///< sample indices, rising
    Neighbourhoods neighbourhoods;     ///< of known[i]: components that explain it

    /// A component that is too thick for a sample within maxMahalanobis of it.
    struct Oversized {
        std::uint32_t component;
        std::uint32_t sample;
    };
    std::vector<Oversized> oversized;  ///< samples rising, and components of a sample
};

/// From where the samples were measured, and from where the map's components were.
struct SensorGeometry {
    const ViewDirections& views;  ///< of the indexed components
    ThicknessLimit limit;         ///< of what explains the samples
};

/// Cost is linear in the samples and does not depend on the size of the map.
///
/// With a `geometry`, a component explains only samples
/// - seen from its own side: u^T Sigma^-1 v > 0 for their directions u, v towards the
///   sensors, which for a flat component compares the signs of its normal with both. So a
///   wall seen from both sides gets components for each, whose views do not cancel;
/// - at which it is thin (ThicknessLimit).
NoveltySplit splitByNovelty(const Mixture<3>& samples, const ComponentIndex& index,
                            const NoveltyParams& params,
                            const SensorGeometry* geometry = nullptr);

/// The rows of a mixture named by `indices`.
Mixture<3> selected(const Mixture<3>& mixture, const std::vector<std::uint32_t>& indices);

}  // namespace hgmm
