#pragma once
#include <mrpt/obs/CObservation.h>
#include <mrpt/poses/CPose3D.h>

#include <Eigen/Core>
#include <cstdint>
#include <memory>
#include <mutex>
#include <vector>

#include "hgmm/likelihood.h"
#include "hgmm/map.h"

namespace hgmm::mrpt_bridge {

constexpr int kMaxPoints = 1000000;

/// Which points of a scan are compared with the map, and how.
struct LikelihoodParams {
    double kernelWidth_m = 0.02;  ///< standard deviation added to all surfaces [m], 0 to 10
    double outlierRatio =
        0.05;  ///< share of points that the map need not explain, in (0, 1)
    /// Points compared, spread over the scan [count], 1 to kMaxPoints.
    int maxPoints = 1000;
    /// More points count together as so many [count], 1 to kMaxPoints: the errors of
    /// neighbours are alike, and a particle filter must not be surer than the scan makes
    /// it.
    int independentPoints = 100;
    double minRange_m = 0.1;   ///< nearer points are left out [m], >= 0
    double maxRange_m = 80.0;  ///< farther points are left out [m], >= minRange_m

    /// Throws std::invalid_argument naming the field.
    void validate() const;
    static const OptionTable<LikelihoodParams>& options();
    bool operator==(const LikelihoodParams& o) const;
};

/// Likelihood of observations given a pose, for particle filters: sums SurfaceLikelihood
/// over a spread subset of the scan's points. The more points, the nearer is its maximum to
/// the pose; its height is that of independentPoints.
///
/// Keeps what calls have in common: the map's surfaces, brought up to date where the map
/// changed since invalidate(), and, for all maps of the process, the points of the last few
/// observations. Const calls may come from several threads. Copies
/// share the surfaces.
class ObservationLikelihood {
 public:
    ObservationLikelihood() = default;
    ObservationLikelihood(const ObservationLikelihood& o) { *this = o; }
    ObservationLikelihood& operator=(const ObservationLikelihood& o);

    /// Log-likelihood [nat], finite, <= 0, and 0 for an empty map and for observations of
    /// unsupported types or without points in range.
    double operator()(const Map& map, const LikelihoodParams& params,
                      const mrpt::obs::CObservation& observation,
                      const mrpt::poses::CPose3D& T_map_robot) const;

    /// To be called when the map has changed.
    void invalidate();
    /// Frees the points of observations, those that other maps asked for included.
    static void forgetObservations();

 private:
    struct Surfaces {
        SurfaceLikelihood likelihood;
        double kernelWidth_m, outlierRatio;
    };
    std::shared_ptr<const Surfaces> surfacesOf(const Map& map,
                                               const LikelihoodParams& params) const;

    mutable std::mutex mutex_;
    mutable std::shared_ptr<Surfaces> surfaces_;  // changed while nobody else holds them
    mutable bool stale_ = false;                  // the map has changed since
};

}  // namespace hgmm::mrpt_bridge
