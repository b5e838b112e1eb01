#pragma once
#include <cstddef>

#include "hgmm/component_index.h"
#include "hgmm/mixture.h"

namespace hgmm {

/// How well a measured point agrees with the surfaces of a map, for localisation: a surface
/// mixture with an outlier floor,
///   log( outlierRatio + (1 - outlierRatio) max_j exp(-1/2 d_j^2) ),
/// d_j the Mahalanobis distance to component j widened by `softeningStd_m`. Each component
/// counts relative to its own peak, so that the value depends neither on the size of the
/// map nor on how often a surface was seen, and is comparable between poses. In
/// [log(outlierRatio), 0].
class SurfaceLikelihood {
 public:
    /// @param softeningStd_m pose search radius [m], >= 0: wider is smoother
    /// @param outlierRatio share of measurements that the map does not explain, in (0, 1)
    /// Throws std::invalid_argument for values outside.
    SurfaceLikelihood(const Mixture<3>& mixture, double softeningStd_m,
                      double outlierRatio);

    /// Log-likelihood of one point in the mixture's frame [nat]. A point that is not finite
    /// is an outlier. Thread-safe.
    double operator()(float x, float y, float z) const;

    std::size_t liveBytes() const { return index_.liveBytes(); }

 private:
    ComponentIndex index_;
    double outlierRatio_;
};

}  // namespace hgmm
