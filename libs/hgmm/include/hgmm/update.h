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

/// A component that lost support.
struct Loss {
    std::uint32_t component;
    double kept;  ///< share of its support [1], in (0, 1]
};

/// Supports at or below this are none [count]: what gives way keeps so much at least.
constexpr float kNoSupport = 1e-6F;

/// Outgrown components give way to those that learn in their place: of each sample that
/// they are too thick for, they lose what they would be given, had they a part in it: its
/// responsibility (3.8), over them and those that explain the sample, times its support.
/// Returns those that lost, rising.
/// @param index of the mixture's components before the samples changed them
std::vector<Loss> giveWay(Mixture<3>& mixture, const ComponentIndex& index,
                          const Mixture<3>& samples, const NoveltySplit& split);

}  // namespace hgmm
