#pragma once
#include <cstdint>
#include <vector>

#include "fusion/novelty.h"
#include "index/component_index.h"

namespace hgmm {

/// What known samples do to a mixture.
struct KnownUpdate {
    std::vector<std::uint32_t> changed;   ///< components, rising
    std::vector<Gaussian<3>> components;  ///< what they are now
    /// For each of them: support, mean and covariance of what it was given. The covariance
    /// is symmetric positive semi-definite.
    std::vector<Gaussian<3>> shares;
};

/// What components become when the known samples that they explain are added: thesis eq.
/// (3.19)-(3.22), with responsibilities (3.8) over each sample's neighbourhood. Sums are
/// taken about each component's old mean, in sample order.
KnownUpdate updateKnown(const Mixture<3>& mixture, const ComponentIndex& index,
                        const Mixture<3>& samples, const NoveltySplit& split);

}  // namespace hgmm
