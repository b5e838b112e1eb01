#pragma once
#include <memory>
#include <optional>

#include "hgmm/map.h"
#include "hgmm/tracker.h"
#include "scan_source.h"

namespace localise {

/// Follows a robot in a map. Searches the whole map where nothing is known of the robot's
/// place, or where it is lost or in doubt for a while.
class Localiser {
 public:
    /// @param start T_map_robot, about; nothing: the map is searched
    Localiser(std::shared_ptr<const hgmm::Map> map, const std::optional<hgmm::Pose>& start);

    /// Where the robot is: T_map_sensor is T_map_robot here, and the covariance is the
    /// robot's. Lost also where the scan and those before it are in doubt. Nothing until
    /// the robot is found for the first time.
    std::optional<hgmm::TrackedPose> next(const TimedScan& timed);

 private:
    bool beginAtStart(const TimedScan& timed);
    bool searchIsDue() const;
    bool search(const TimedScan& timed);

    std::shared_ptr<const hgmm::Map> map_;
    std::optional<hgmm::Pose> start_;
    std::optional<hgmm::ScanTracker> tracker_;
    int doubtfulScans_ = 0;  // in a row
};

}  // namespace localise
