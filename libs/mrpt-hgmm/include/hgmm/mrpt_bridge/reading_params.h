#pragma once
#include "hgmm/option.h"

namespace hgmm::mrpt_bridge {

/// What a reading without return says of the space before it, and what intensities mean.
/// Readings at or beyond the sensor's own maxRange need no option: they clear space up to
/// it and mark nothing.
struct ReadingParams {
    /// Whether rays of planar lasers that are flagged invalid, or have no range, clear
    /// space. The name is that of MRPT's grid map.
    bool considerInvalidRangesAsFreeSpace = true;
    /// Whether rays of rotating lidars without return clear space: they may have met
    /// something dark, wet or too near as well as the sky.
    bool considerNoReturnsAsFreeSpace = false;
    /// How far such rays clear space: share of the range seen beside them, in the row of
    /// rays, or of the sensor's maxRange where no ray has a return [1], 0 to 1. (MRPT's
    /// grid map takes the last valid range.) Half of maxRange would reach through the walls
    /// of most rooms, where dark patches do not return anything either.
    double clearedShareOfRange = 0.5;
    /// What intensities of CObservationPointCloud are divided by [counts], > 0. 0: 1, 255
    /// or 65535, as the scan tells (intensityScaleOf). A map takes it over from the first
    /// scan that tells one, so that a surface has one intensity in all scans.
    double intensityScale = 0.0;

    /// Throws std::invalid_argument naming the field.
    void validate() const;
    static const OptionTable<ReadingParams>& options();
    bool operator==(const ReadingParams& o) const;
};

}  // namespace hgmm::mrpt_bridge
