#pragma once
#include <cstdint>
#include <vector>

#include "hgmm/component_index.h"
#include "hgmm/novelty.h"

namespace hgmm {

/// What known samples did to a mixture.
struct KnownUpdate {
    std::vector<std::uint32_t> changed;  ///< components, rising
    /// For each of them: support, mean and covariance of what it was given. The covariance
    /// is symmetric positive semi-definite.
    std::vector<Gaussian<3>> shares;
};

/// Adds known samples to the components that explain them: thesis eq. (3.19)-(3.22), with
/// responsibilities (3.8) over each sample's neighbourhood. Sums are taken about each
/// component's old mean, in sample order.
KnownUpdate updateKnown(Mixture<3>& mixture, const ComponentIndex& index,
                        const Mixture<3>& samples, const NoveltySplit& split);

/// Outgrown components give way to those that learn in their place: each loses the support
/// of the samples that it is too thick for, but keeps a millionth of a hit. Returns those
/// that lost, rising.
std::vector<std::uint32_t> giveWay(Mixture<3>& mixture, const NoveltySplit& split);

}  // namespace hgmm
