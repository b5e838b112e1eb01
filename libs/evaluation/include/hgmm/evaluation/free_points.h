#pragma once
#include <Eigen/Core>
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "hgmm/evaluation/points.h"

namespace hgmm::evaluation {

/// Distances before a hit, along its ray.
struct NearBand {
    double min_m = 0.10;  ///< [m], >= 0
    double max_m = 0.60;  ///< [m], > min_m

    /// Throws std::invalid_argument unless 0 <= min_m < max_m, both finite.
    void validate() const;
};

/// The hard negatives of a sensor (protocol, step 2): 0.05 to 0.30 m before the hit for
/// depth cameras, 0.10 to 0.60 m for lidars.
/// @param observationClass MRPT class, such as "mrpt::obs::CObservation3DRangeScan"
NearBand nearBandOf(const std::string& observationClass);

/// The easy negatives: all of a ray but its ends.
struct FreeBand {
    double fromSensor_m = 0.10;  ///< left out after the sensor [m], >= 0
    double beforeHit_m = 0.15;   ///< left out before the hit [m], >= 0

    /// Throws std::invalid_argument unless both are finite and >= 0.
    void validate() const;
};

/// A range along a ray of length `ray_m` that lies `share` in [0, 1) of the way through a
/// band; nothing if the ray is too short to hold the whole of the near band, or anything of
/// the free band.
std::optional<double> rangeIn(const NearBand& band, double ray_m, double share);
std::optional<double> rangeIn(const FreeBand& band, double ray_m, double share);

/// Points that a ray crossed before its hit, at most one for each hit.
struct FreePoints {
    Points points_map;              ///< [m]
    std::vector<std::size_t> hits;  ///< index of the hit of each
};

}  // namespace hgmm::evaluation
