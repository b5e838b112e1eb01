#pragma once
#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <vector>

#include "hgmm/slam/uncertain_pose.h"
#include "hgmm/tracker.h"

namespace hgmm::slam {

/// Follows a robot from scan to scan (ScanTracker), as increments of its pose.
class Odometry {
 public:
    /// @param T_robot_sensor where the sensor is on the robot
    Odometry(const MapParams& map, const Pose& T_robot_sensor);

    /// Takes the next scan.
    /// @param scan its T_map_sensor is not used
    /// @param time_s as of ScanTracker::track
    /// @param T_previous_robot how the robot moved since the last scan by other means, such
    /// as wheels
    /// @return how it moved since the last scan that is held; the identity for the first
    UncertainPose step(const Scan& scan, double time_s,
                       const std::optional<UncertainPose>& T_previous_robot);

    /// The state, as of ScanTracker::save.
    std::vector<std::uint8_t> save() const;
    /// Goes on from save(). Throws as ScanTracker::load does.
    static Odometry load(const std::vector<std::uint8_t>& state,
                         const std::function<ScanSamples(std::size_t scan)>& samplesOfScan);

    /// Of the last scan.
    const ScanSamples& lastSamples() const { return tracker_.lastSamples(); }
    /// Whether the last scan said nothing of the motion, which is a guess then.
    bool lost() const { return last_.lost; }
    /// Whether further scans are compared with the last one, or with what was before: it is
    /// not lost, or odometry begins anew with it.
    bool held() const { return !last_.lost || last_.inserted; }

 private:
    template <typename Archive, typename Self>
    static void archive(Archive& a, Self& self);

    Pose T_robot_sensor_;
    ScanTracker tracker_;
    TrackedPose last_;   // in the map of the tracker
    PoseEstimate held_;  // of the last scan that is held
    bool started_ = false;
};

/// A motion by wheels or another program, and how far off it may be: a tenth of it.
UncertainPose givenMotion(const Pose& T_previous_robot);

}  // namespace hgmm::slam
