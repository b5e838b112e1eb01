#pragma once
#include <cstddef>
#include <cstdint>
#include <vector>

#include "hgmm/component_index.h"
#include "hgmm/em.h"
#include "hgmm/mixture.h"
#include "hgmm/views.h"

namespace hgmm {

/// Splits samples into known and novel (thesis 3.3.3).
///
/// The thesis thresholds the log-likelihood of the weighted mixture at lambda_n = -10.5;
/// weights shrink as a map grows, so that threshold drifts. Here it is local: a sample is
/// known if it lies within `maxMahalanobis` of one component, whatever else the map holds.
struct NoveltyParams {
    double maxMahalanobis = 3.0;  ///< [sigma], in (0, 4]

    /// Throws std::invalid_argument naming the field.
    void validate() const;
};

struct NoveltySplit {
    std::vector<std::uint32_t> novel;  ///< sample indices, rising
    std::vector<std::uint32_t> known;  ///< sample indices, rising
    Neighbourhoods neighbourhoods;     ///< of known[i]: components within maxMahalanobis
};

/// Who saw what, for telling the two sides of a thin object apart.
struct Sides {
    const Views& views;            ///< of the indexed components
    Eigen::Vector3d sensorOrigin;  ///< of the samples, in their frame
};

/// Cost is linear in the samples and does not depend on the size of the map.
///
/// With `sides`, a component explains only samples seen from its own side:
/// u^T Sigma^-1 v > 0 for their directions u, v towards the sensors, which for a flat
/// component compares the signs of its normal with both. So a wall seen from both sides
/// gets components for each, whose views do not cancel.
NoveltySplit splitByNovelty(const Mixture<3>& samples, const ComponentIndex& index,
                            const NoveltyParams& params, const Sides* sides = nullptr);

/// The rows of a mixture named by `indices`.
Mixture<3> selected(const Mixture<3>& mixture, const std::vector<std::uint32_t>& indices);

}  // namespace hgmm
