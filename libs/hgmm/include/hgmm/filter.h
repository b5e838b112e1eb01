#pragma once
#include <cstddef>
#include <vector>

#include "hgmm/mixture.h"
#include "hgmm/scan.h"

namespace hgmm {

/// Reduces a scan to samples: one per occupied leaf, with the moments of the leaf's points.
/// Leaves grow in octaves, with the square root of the range: midway between the spacing of
/// a sensor's rays, which grows with the range, and the detail that a map is wanted for,
/// which does not.
struct FilterParams {
    double leafAtOneMetre_m = 0.04;  ///< leaf edge at range 1 m [m], > 0
    double minLeaf_m = 0.01;         ///< smallest leaf edge [m], > 0
    double minRange_m = 0.1;         ///< nearer points are dropped [m], >= 0
    double maxRange_m = 300.0;       ///< farther points are dropped [m], > minRange_m
    double noiseStd_m = 0.003;       ///< range noise at range 0, one sigma [m], > 0
    double noisePerRange = 0.001;    ///< its growth with range [m/m], >= 0

    /// Throws std::invalid_argument naming the field.
    void validate() const;

    /// Standard deviation [m] of a measurement at `range_m`.
    double noiseAt(double range_m) const { return noiseStd_m + noisePerRange * range_m; }
};

/// What the filter kept and dropped [points].
struct FilterCounts {
    std::size_t used = 0;
    std::size_t notFinite = 0;
    std::size_t outOfRange = 0;  ///< nearer than minRange_m or farther than maxRange_m
};

/// Samples in the sensor frame: support = points in the leaf, mean = their centroid,
/// covariance = their scatter plus the sensor's noise variance (so a leaf with one point is
/// a Gaussian of the size of the measurement's uncertainty, and later stages need no noise
/// model of their own). The order is that of each leaf's first point, whatever the number
/// of threads.
Mixture<3> filterScan(const Scan& scan, const FilterParams& params,
                      FilterCounts* counts = nullptr);

/// The same samples in another frame.
Mixture<3> transformed(const Mixture<3>& mixture, const Pose& T_target_source);

}  // namespace hgmm
