#pragma once
#include <cstddef>
#include <cstdint>
#include <vector>

#include "hgmm/component_index.h"
#include "hgmm/em.h"
#include "hgmm/mixture.h"
#include "hgmm/thickness.h"
#include "hgmm/views.h"

namespace hgmm {

/// Splits samples into known and novel (thesis 3.3.3).
///
/// The thesis thresholds the log-likelihood of the weighted mixture at lambda_n = -10.5;
/// weights shrink as a map grows, so that threshold drifts. Here it is local: a sample is
/// known if it lies within `maxMahalanobis` of one component, whatever else the map holds.
///
/// What lies within some sigmas of a wide component would make it wider still, scan after
/// scan. In the thesis the low density of wide components prevents that; here a component
/// explains only samples at which it is thin beside the cells of a first guess.
struct NoveltyParams {
    double maxMahalanobis = 3.0;  ///< [sigma], in (0, 4]
    /// Standard deviation across the surface that a ray meets, besides that of the noise
    /// [cell edges at the ray's range, CellParams::edgeAt], in [0.001, 1000]. The default,
    /// 1 / sqrt(12), is that of hits all over a cell.
    double maxThickness = 0.29;

    /// Throws std::invalid_argument naming the field.
    void validate() const;
};

struct NoveltySplit {
    std::vector<std::uint32_t> novel;  ///< sample indices, rising
    std::vector<std::uint32_t> known;  ///< sample indices, rising
    Neighbourhoods neighbourhoods;     ///< of known[i]: components that explain it

    /// A component that is too thick for a sample within maxMahalanobis of it.
    struct Outgrown {
        std::uint32_t component;
        std::uint32_t sample;
    };
    std::vector<Outgrown> outgrown;  ///< samples rising, and components of a sample
};

/// From where samples were seen, and who saw what the map holds.
struct Sighting {
    const Views& views;    ///< of the indexed components
    ThicknessLimit limit;  ///< of what explains the samples
};

/// Cost is linear in the samples and does not depend on the size of the map.
///
/// With a `sighting`, a component explains only samples
/// - seen from its own side: u^T Sigma^-1 v > 0 for their directions u, v towards the
///   sensors, which for a flat component compares the signs of its normal with both. So a
///   wall seen from both sides gets components for each, whose views do not cancel;
/// - at which it is thin (ThicknessLimit).
NoveltySplit splitByNovelty(const Mixture<3>& samples, const ComponentIndex& index,
                            const NoveltyParams& params,
                            const Sighting* sighting = nullptr);

/// The rows of a mixture named by `indices`.
Mixture<3> selected(const Mixture<3>& mixture, const std::vector<std::uint32_t>& indices);

}  // namespace hgmm
