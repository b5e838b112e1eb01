#include <mrpt/maps/CHGMMOccupancyMap.h>
#include <mrpt/maps/CSimplePointsMap.h>
#include <mrpt/poses/CPose2D.h>

#include <stdexcept>
#include <string>
#include <vector>

#include "localisation/surface_matching.h"

namespace bridge = ::hgmm::mrpt_bridge;

namespace mrpt::maps {

namespace {

/// What of another map is matched: its points, or the means of its components.
class MatchedPoints {
 public:
    explicit MatchedPoints(const CMetricMap* map) {
        if (map == nullptr)
            throw std::runtime_error("CHGMMOccupancyMap: no map to match with");
        if (const auto* points = dynamic_cast<const CPointsMap*>(map)) {
            show(*points);
        } else if (const auto* mixture = dynamic_cast<const CHGMMOccupancyMap*>(map)) {
            copyMeans(mixture->model());
        } else if (const auto* simple = map->getAsSimplePointsMap()) {
            show(*simple);
        } else {
            throw std::runtime_error(
                std::string("CHGMMOccupancyMap cannot be matched with a ") +
                map->GetRuntimeClass()->className +
                ": it takes points maps, maps that hold exactly one CSimplePointsMap, and "
                "other CHGMMOccupancyMaps");
        }
    }

    const bridge::PointsView& view() const { return view_; }

 private:
    void show(const CPointsMap& points) {
        view_ = {points.getPointsBufferRef_x().data(), points.getPointsBufferRef_y().data(),
                 points.getPointsBufferRef_z().data(), points.size()};
    }
    void copyMeans(const ::hgmm::Map& map) {
        for (int d = 0; d < 3; ++d)
            for (const float mean : map.mixture().mean[d])
                means_[d].push_back(static_cast<float>(map.origin()[d] + double(mean)));
        view_ = {means_[0].data(), means_[1].data(), means_[2].data(), means_[0].size()};
    }

    bridge::PointsView view_;
    std::vector<float> means_[3];
};

}  // namespace

void CHGMMOccupancyMap::determineMatching2D(const CMetricMap* otherMap,
                                            const mrpt::poses::CPose2D& otherMapPose,
                                            mrpt::tfest::TMatchingPairList& correspondences,
                                            const TMatchingParams& params,
                                            TMatchingExtraResults& extraResults) const {
    const MatchedPoints other(otherMap);
    caches_.matching().match<2>(model_, other.view(), mrpt::poses::CPose3D(otherMapPose),
                                params, correspondences, extraResults);
}

void CHGMMOccupancyMap::determineMatching3D(const CMetricMap* otherMap,
                                            const mrpt::poses::CPose3D& otherMapPose,
                                            mrpt::tfest::TMatchingPairList& correspondences,
                                            const TMatchingParams& params,
                                            TMatchingExtraResults& extraResults) const {
    const MatchedPoints other(otherMap);
    caches_.matching().match<3>(model_, other.view(), otherMapPose, params, correspondences,
                                extraResults);
}

float CHGMMOccupancyMap::compute3DMatchingRatio(const CMetricMap* otherMap,
                                                const mrpt::poses::CPose3D& otherMapPose,
                                                const TMatchingRatioParams& params) const {
    TMatchingParams matching;
    matching.maxDistForCorrespondence = params.maxDistForCorr;
    mrpt::tfest::TMatchingPairList pairs;
    TMatchingExtraResults results;
    determineMatching3D(otherMap, otherMapPose, pairs, matching, results);
    return results.correspondencesRatio;
}

}  // namespace mrpt::maps
