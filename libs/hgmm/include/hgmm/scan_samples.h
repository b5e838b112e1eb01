#pragma once
#include "hgmm/filter.h"
#include "hgmm/map_params.h"
#include "hgmm/mixture.h"
#include "hgmm/scan.h"
#include "hgmm/thickness.h"

namespace hgmm {

/// A scan's own mixture, in the sensor's frame: what Map::insert makes of a scan before it
/// looks at the map. It is the same wherever the scan was taken from, so that particles,
/// which put one scan into many maps, share it.
struct ScanSamples {
    Mixture<3>
        samples_sensor;   ///< after the filter (filterScan), gaps bridged (bridgeGaps)
    FilterCounts points;  ///< that the filter kept and dropped
    /// normalOfRays(samples_sensor): without it, those of a planar laser pass for surfaces
    /// across its plane.
    Eigen::Vector3d normalOfRays_sensor = Eigen::Vector3d::Zero();
};

/// Uses params.filter and params.cells. Throws std::invalid_argument for a malformed scan
/// (Scan::validate) and for fields out of range.
ScanSamples samplesOf(const Scan& scan, const MapParams& params);

}  // namespace hgmm
