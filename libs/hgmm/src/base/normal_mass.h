#pragma once
#include <cmath>

#include "base/dual.h"

namespace hgmm {

/// P(low <= Z <= high) of a standard normal Z, for double or Dual. Both ends are turned to
/// the lower tail, where erfc keeps its digits.
template <typename T>
T normalMass(const T& low, const T& high) {
    using std::erfc;
    constexpr double kSqrtHalf = 0.70710678118654752440;
    return valueOf(low) > 0 ? 0.5 * (erfc(kSqrtHalf * low) - erfc(kSqrtHalf * high))
                            : 0.5 * (erfc(-kSqrtHalf * high) - erfc(-kSqrtHalf * low));
}

}  // namespace hgmm
