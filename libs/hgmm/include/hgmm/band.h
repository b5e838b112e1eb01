#pragma once
#include <algorithm>

#include "hgmm/mixture.h"
#include "hgmm/views.h"

namespace hgmm {

/// How the distance variable W is distributed in front of a surface component (thesis 4.1):
/// a point is a hit (w = 0) with probability 1 - freeShare, else it lies w in front of the
/// surface, along the component's view. The density of w is even up to the width of the
/// band, so that hits and free points near a surface are weighed alike for every component,
/// and falls as 1/w from there to its reach, where the free-space mixture takes over.
struct BandParams {
    /// Share of free points within the band's width [1], in (0, 1). At 0.5 the probability
    /// of a point within the band is that of a hit against an equally likely free point.
    double freeShare = 0.45;
    double bandBase_m = 0.5;          ///< width of the band at range 0 [m], > 0
    double bandPerRange = 0.015;      ///< its growth with range [m/m], >= 0
    double bandReachPerRange = 0.25;  ///< reach per range, at least the width [1], >= 0

    /// Throws std::invalid_argument naming the field.
    void validate() const;

    /// [m]
    double width(double range_m) const { return bandBase_m + bandPerRange * range_m; }
    /// [m]
    double reach(double range_m) const {
        return std::max(width(range_m), bandReachPerRange * range_m);
    }
    /// Free points per hit and metre of w within the width [1/m]. Beyond, times width / w.
    double freePerMetre(double range_m) const {
        return freeShare / ((1 - freeShare) * width(range_m));
    }
};

/// The 4-tuple component over (X, W) of a surface component with a band (thesis 4.1.3): w
/// is 0 with probability 1 - freeShare and even in (0, width_m) else, and x = s + w u with
/// s from the surface. Support counts hits and free points. Conditioning on W = 0, thesis
/// eq. (4.11) and (4.12), gives back the surface's mean and covariance exactly.
Gaussian<4> augmented(const Gaussian<3>& surface, const View& view, double width_m,
                      double freeShare);

/// Space that rays passed on the way to hits, in closed form: distances w in [from_m, to_m]
/// along the rays from the points of `hits` (their mean and covariance) to `sensorOrigin`,
/// each distance equally likely (thesis 4.2.1 without sampling). The bundle narrows towards
/// the sensor. Support is that of the hits.
Gaussian<4> freeSlab(const Gaussian<3>& hits, const Eigen::Vector3d& sensorOrigin,
                     double from_m, double to_m);

}  // namespace hgmm
