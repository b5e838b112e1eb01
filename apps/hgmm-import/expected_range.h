#pragma once
#include <limits>
#include <string>

namespace hgmm::importer {

/// Which median ranges of a recording are credible [m]. Outside of the usual ones the
/// user is warned; outside of the possible ones the import is refused.
struct ExpectedRange {
    double possibleLeast_m = 0;
    double possibleMost_m = std::numeric_limits<double>::infinity();
    double usualLeast_m = 0;
    double usualMost_m = std::numeric_limits<double>::infinity();
    std::string advice;  ///< what to check
};

/// Of a depth camera. A scale that the user gave is doubted only if it is impossible.
inline ExpectedRange depthCameraRange(bool scaleGiven) {
    ExpectedRange range;
    range.possibleLeast_m = 0.05;
    range.possibleMost_m = 60;
    if (!scaleGiven) {
        range.usualLeast_m = 0.5;
        range.usualMost_m = 15;
    }
    range.advice =
        "check --depth-scale, the units of the depth images a metre (1000 for millimetres, "
        "5000 as the TUM benchmark has it)";
    return range;
}

/// Of point clouds, unless the user said their unit.
inline ExpectedRange cloudRange(bool scaleGiven) {
    ExpectedRange range;
    if (scaleGiven) return range;
    range.possibleMost_m = 500;
    range.usualLeast_m = 0.05;
    range.usualMost_m = 150;
    range.advice =
        "check the unit and the origin of the points: --units-per-metre is 1000 for "
        "millimetres, and 1 says that they are metres";
    return range;
}

}  // namespace hgmm::importer
