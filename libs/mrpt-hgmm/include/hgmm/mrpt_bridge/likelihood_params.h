#pragma once
#include "hgmm/option.h"

namespace hgmm::mrpt_bridge {

constexpr int kMaxPoints = 1000000;

/// Which points of a scan are compared with the map, and how.
struct LikelihoodParams {
    /// Standard deviation added to all surfaces [m], 0 to 10. Where this, outlierRatio and
    /// independentPoints are 0, all three follow from the spread of the poses that were
    /// asked about at the observation before. One that is set fixes all; those left at 0
    /// are 0.02 m, 0.05 and 60 then.
    double kernelWidth_m = 0;
    /// Share of points that the map need not explain, in (0, 1), or 0.
    double outlierRatio = 0;
    /// Points compared, spread over the scan [count], 1 to kMaxPoints; 0: 60 of a planar
    /// laser's, 1000 of other scans, whose poses have six dimensions.
    int maxPoints = 0;
    /// More points count together as so many [count], 0 to kMaxPoints: the errors of
    /// neighbours are alike, and a particle filter must not be surer than the scan makes
    /// it.
    int independentPoints = 0;
    double minRange_m = 0.1;   ///< nearer points are left out [m], >= 0
    double maxRange_m = 80.0;  ///< farther points are left out [m], >= minRange_m

    /// Throws std::invalid_argument naming the field.
    void validate() const;
    static const OptionTable<LikelihoodParams>& options();
    bool operator==(const LikelihoodParams& o) const;
};

}  // namespace hgmm::mrpt_bridge
