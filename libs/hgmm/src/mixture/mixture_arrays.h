#pragma once
#include <utility>

namespace hgmm {

/// Calls visit(array) for all arrays of a Mixture, const or not: support, means, packed
/// covariances.
template <typename Mix, typename Visitor>
void forEachArray(Mix& mixture, Visitor&& visit) {
    visit(mixture.support);
    for (auto& axis : mixture.mean) visit(axis);
    for (auto& entry : mixture.covariance) visit(entry);
}

}  // namespace hgmm
