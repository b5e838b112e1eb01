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
#include "hgmm/mrpt_bridge/likelihood_params.h"
#include "localisation/asked_poses.h"

namespace hgmm::mrpt_bridge {

/// Likelihood of observations given a pose, for particle filters: sums SurfaceLikelihood
/// over a spread subset of the scan's points. The more points, the nearer is its maximum to
/// the pose; its height is that of independentPoints. Unless options fix the kernel, it
/// follows from the poses that maps of the same family were asked about at the observation
/// before.
///
/// Keeps what calls have in common: the map's surfaces, brought up to date where the map
/// changed since invalidate(), and, for all maps of the process, the points of the last few
/// observations. Const calls may come from several threads. Copies share the surfaces.
class ObservationLikelihood {
    struct Surfaces;

 public:
    ObservationLikelihood();
    ObservationLikelihood(const ObservationLikelihood& o);
    ObservationLikelihood& operator=(const ObservationLikelihood& o);

    /// Log-likelihood [nat], finite, <= 0, and 0 for an empty map and for observations of
    /// unsupported types or without points in range.
    double operator()(const Map& map, const LikelihoodParams& params,
                      const mrpt::obs::CObservation& observation,
                      const mrpt::poses::CPose3D& T_map_robot) const;

    /// To be called when the map has changed.
    void invalidate();
    /// Poses asked about until now do not count for this map any more.
    void forgetPoses();
    /// What a copy of the map takes over that is made through an archive.
    struct Heritage {
        MapFamily family;
        std::weak_ptr<const Surfaces> surfaces;
    };
    Heritage heritage() const;
    /// The map has been read, and is the copy of another one.
    void inherit(const Heritage& heritage);
    /// Frees the points of observations, those that other maps asked for included.
    static void forgetObservations();

 private:
    struct Surfaces {
        SurfaceLikelihood likelihood;
        double kernelWidth_m, outlierRatio;
    };
    std::shared_ptr<const Surfaces> surfacesOf(const Map& map,
                                               const LikelihoodKernel& kernel) const;

    MapFamily family_;
    std::uint64_t number_;  ///< of this object in the process

    mutable std::mutex mutex_;
    mutable std::shared_ptr<const Surfaces> surfaces_;
    /// The same if no other object may hold them: only then are they brought up to date
    /// where they are, and not replaced.
    mutable std::shared_ptr<Surfaces> ownSurfaces_;
    mutable bool stale_ = false;  ///< the map has changed since
};

}  // namespace hgmm::mrpt_bridge
