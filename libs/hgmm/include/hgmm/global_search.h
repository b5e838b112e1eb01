#pragma once
#include <optional>

#include "hgmm/export.h"
#include "hgmm/map.h"
#include "hgmm/scan.h"
#include "hgmm/tracker.h"

namespace hgmm {

/// How a sensor is looked for in a whole map.
struct GlobalSearchParams {
    int maxPositions = 2000;  ///< that are rated [count], in [1, 1e6]
    int headings = 24;        ///< of each position [count], in [1, 360]
    int aligned = 40;         ///< best candidates that are aligned [count], in [1, 1e4]
    /// Share of the samples that must lie on surfaces at the best pose [1], in (0, 1].
    double minOverlap = 0.5;
    /// Another place explains so much less of the scan, or both are refused [1], in [0, 1].
    double minLead = 0.1;

    /// Throws std::invalid_argument naming the field.
    HGMM_EXPORT void validate() const;
};

/// Looks for a sensor in a map, with nothing known but that the sensor is upright: its z
/// axis is that of the map, give or take a few degrees. Positions are the means of free
/// space, for sensors are where rays passed; each is rated in all headings with few samples
/// and a wide kernel, and the best are aligned with the surfaces. Nothing, where too little
/// of the scan is explained or two places explain it alike. Does not depend on the number
/// of threads.
/// @param scan of that map's parameters (samplesOf)
/// Throws std::invalid_argument for params out of range.
HGMM_EXPORT std::optional<PoseEstimate> findInMap(const Map& map, const ScanSamples& scan,
                                                  const GlobalSearchParams& params = {});

}  // namespace hgmm
