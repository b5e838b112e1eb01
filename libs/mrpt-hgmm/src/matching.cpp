#include <mrpt/maps/CHGMMOccupancyMap.h>

#include <stdexcept>
#include <string>

namespace mrpt::maps {

namespace {

[[noreturn]] void refuse(const char* method) {
    throw std::runtime_error(std::string("CHGMMOccupancyMap::") + method +
                             " is not available yet: matching against an HGMM map arrives "
                             "with scan registration. "
                             "Put a points map into the same configuration for ICP.");
}

}  // namespace

void CHGMMOccupancyMap::determineMatching2D(const CMetricMap*, const mrpt::poses::CPose2D&,
                                            mrpt::tfest::TMatchingPairList&,
                                            const TMatchingParams&,
                                            TMatchingExtraResults&) const {
    refuse("determineMatching2D");
}

void CHGMMOccupancyMap::determineMatching3D(const CMetricMap*, const mrpt::poses::CPose3D&,
                                            mrpt::tfest::TMatchingPairList&,
                                            const TMatchingParams&,
                                            TMatchingExtraResults&) const {
    refuse("determineMatching3D");
}

float CHGMMOccupancyMap::compute3DMatchingRatio(const CMetricMap*,
                                                const mrpt::poses::CPose3D&,
                                                const TMatchingRatioParams&) const {
    refuse("compute3DMatchingRatio");
}

float CHGMMOccupancyMap::squareDistanceToClosestCorrespondence(float, float) const {
    refuse("squareDistanceToClosestCorrespondence");
}

}  // namespace mrpt::maps
