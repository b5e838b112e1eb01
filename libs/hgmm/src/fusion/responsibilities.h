#pragma once
#include <algorithm>
#include <vector>

#include "base/portable_math.h"

namespace hgmm {

/// Weights that sum to 1 from their logarithms.
inline void normalise(std::vector<double>& p) {
    const double largest = *std::max_element(p.begin(), p.end());
    double sum = 0;
    for (double& v : p) sum += v = portable::exp(v - largest);
    for (double& v : p) v /= sum;
}

}  // namespace hgmm
