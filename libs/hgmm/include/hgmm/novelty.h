#pragma once
#include <cstddef>
#include <cstdint>
#include <vector>

#include "hgmm/component_index.h"
#include "hgmm/em.h"
#include "hgmm/mixture.h"

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

/// Cost is linear in the samples and does not depend on the size of the map.
NoveltySplit splitByNovelty(const Mixture<3>& samples, const ComponentIndex& index,
                            const NoveltyParams& params);

/// The rows of a mixture named by `indices`.
Mixture<3> selected(const Mixture<3>& mixture, const std::vector<std::uint32_t>& indices);

}  // namespace hgmm
