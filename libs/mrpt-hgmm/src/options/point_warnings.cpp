#include "options/point_warnings.h"

#include <cmath>
#include <string>

#include "hgmm/option.h"
#include "options/warnings.h"

namespace hgmm::mrpt_bridge {

namespace {

void warnOfRange(const FilterCounts& points, const FilterParams& params) {
    if (points.used > 0 || points.cut + points.tooNear == 0) return;
    const std::string farther =
                          "farther than maxRange_m = " + numberText(params.maxRange_m),
                      nearer = "nearer than minRange_m = " + numberText(params.minRange_m);
    warn("all points of a scan are " +
         (points.tooNear == 0 ? farther
          : points.cut == 0   ? nearer
                              : farther + " or " + nearer) +
         " [m]: no surface was added");
}

}  // namespace

void warnOfPoints(const FilterCounts& points, const FilterParams& params) {
    warnOfRange(points, params);
    if (points.doublings > 0)
        warn("a scan has more than " + std::to_string(kMaxSamples) +
             " samples at resolution_m = " + numberText(params.resolution_m) +
             " [m]: it is read at " +
             numberText(std::ldexp(params.resolution_m, points.doublings)) + " [m]");
}

}  // namespace hgmm::mrpt_bridge
