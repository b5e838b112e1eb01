#pragma once
#include <Eigen/Core>
#include <cstddef>
#include <optional>
#include <vector>

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

/// Where sensors may have been in a map, for rays passed there.
struct FreePositions {
    std::vector<Eigen::Vector3d> positions_local;  ///< from the map's origin [m]
    double spacing_m = 0.0;  ///< edge of the cells they are taken from
};

/// Means of free space, at most `most`: the first of each cell of a grid that is as fine as
/// it may be, .5 m at the finest.
HGMM_EXPORT FreePositions freePositionsOf(const Map& map, std::size_t most);

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
