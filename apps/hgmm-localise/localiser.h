#pragma once
#include <memory>
#include <optional>

#include "hgmm/map.h"
#include "hgmm/tracker.h"
#include "scan_source.h"

namespace localise {

/// Follows a robot in a map: looks for it in the whole map where nothing is known, or where
/// it is lost for a while.
class Localiser {
 public:
    /// @param start of the robot; nothing: the map is searched
    Localiser(std::shared_ptr<const hgmm::Map> map, const std::optional<hgmm::Pose>& start);

    /// Where the robot is: T_map_sensor is T_map_robot here, and so is the covariance.
    hgmm::TrackedPose next(const TimedScan& timed);

 private:
    bool search(const TimedScan& timed);

    std::shared_ptr<const hgmm::Map> map_;
    std::optional<hgmm::Pose> start_;
    std::optional<hgmm::ScanTracker> tracker_;
    int lostScans_ = 0;
};

}  // namespace localise
