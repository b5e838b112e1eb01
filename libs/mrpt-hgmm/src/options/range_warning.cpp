#include "options/range_warning.h"

#include "hgmm/option.h"
#include "options/warnings.h"

namespace hgmm::mrpt_bridge {

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

}  // namespace hgmm::mrpt_bridge
