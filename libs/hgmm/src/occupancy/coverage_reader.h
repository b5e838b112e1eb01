#pragma once
#include <cstddef>
#include <vector>

#include "occupancy/coverage.h"

namespace hgmm {

/// Reads coverage at points that follow each other closely. It remembers where it looked
/// last, so the coverage must not change. Not for use by several threads.
class Coverage::Reader {
 public:
    explicit Reader(const Coverage& coverage)
        : coverage_(coverage), last_(coverage.octaves().size()) {}

    /// Coverage::at(x).
    double at(const double* x) {
        const double share = shareAt(x);
        return share * share;
    }
    /// Coverage::shareAt(x).
    double shareAt(const double* x);

 private:
    const Coverage& coverage_;
    std::vector<LastGroup> last_;  ///< by octave
    std::size_t first_ = 0;        ///< lattice to ask first: the last one that was full
};

}  // namespace hgmm
