#include "occupancy/coverage_reader.h"

#include <algorithm>

namespace hgmm {

double Coverage::Reader::shareAt(const double* x) {
    double best = 0.0;
    for (std::size_t k = 0; k < last_.size(); ++k) {
        // That of the last time comes first, the others follow rising.
        const std::size_t i = k == 0 ? first_ : k <= first_ ? k - 1 : k;
        best = std::max(best, coverage_.shareAt(x, coverage_.octaves()[i], last_[i]));
        if (best == 1.0) {
            first_ = i;
            break;
        }
    }
    return best;
}

}  // namespace hgmm
