#include "hgmm/tracker.h"

namespace hgmm {

void TrackerParams::validate() const {
    requireInRange("firstDeviation_m", firstDeviation_m, 1e-3, 1e3);
    requireInRange("firstDeviation_rad", firstDeviation_rad, 1e-4, 1.0);
    requireInRange("maxSamples", maxSamples, 50, 1e7);
    requireInRange("minOverlap", minOverlap, 1e-6, 1.0);
    requireInRange("insertEvery_m", insertEvery_m, 0.0, 1e3);
    requireInRange("insertEvery_rad", insertEvery_rad, 0.0, 7.0);
    requireInRange("mapRadius_m", mapRadius_m, 1.0, 1e6);
}

}  // namespace hgmm
