#pragma once
#include <cstddef>
#include <memory>
#include <optional>
#include <vector>

#include "hgmm/tracker.h"
#include "occupancy/patch_tree.h"
#include "tracking/local_map.h"
#include "tracking/motion.h"
#include "tracking/scan_alignment.h"

namespace hgmm {

/// What became of a search.
struct FoundPose {
    PoseHypothesis best;
    bool isBelieved = false;
    double conflict = 0.0;  ///< share of the scan in free space or behind surfaces
};

struct ScanTracker::Impl {
    Impl(const MapParams& mapParams, const TrackerParams& trackerParams,
         const PoseEstimate& start);

    void require(const Scan& scan, double time_s,
                 const std::optional<MotionIncrement>& odometry,
                 const std::vector<float>& pointTimes_s) const;
    double sinceLast(double time_s) const;
    /// How far the sensor may be from where it is guessed to be, for want of a velocity or
    /// after a gap.
    SearchRadius unknownSince(double time_s) const;
    PoseEstimate predict(double time_s,
                         const std::optional<MotionIncrement>& odometry) const;
    const Map& map() const { return given ? *given : *local.map(); }
    /// How far off the prior may be.
    SearchRadius searchRadius(const PoseEstimate& prior) const;
    bool isDoubtful(const PoseHypothesis& found, const PoseEstimate& prior) const;
    /// Whether the sensor is not lost.
    bool isBelieved(const PoseHypothesis& found, const PoseEstimate& prior) const;
    bool isAbrupt(double share, double most) const {
        return !given && conflict && share > *conflict + most;
    }
    /// @param vague the sensor may have come far since the last scan
    FoundPose find(const PoseEstimate& prior, bool vague) const;
    void renewTarget();
    /// A map of the last scan alone. Returns whether it is in it.
    bool beginAnew();
    /// All but samples and what follows from the map (StateWriter, StateReader).
    template <typename Archive>
    void archive(Archive& a);

    TrackerParams params;
    PoseEstimate pose;             ///< of the last scan
    std::optional<double> time_s;  ///< of the last scan
    std::optional<Velocity> velocity;
    SearchRadius fastest{0.0, 0.0};  ///< so far [m/s], [rad/s]: one that stands may go on
    PriorDeviation deviation;
    double overlap = 0.0;            ///< of the last scan
    std::optional<double> conflict;  ///< FoundPose::conflict of the last scan not lost
    int lostInARow = 0;              ///< scans that hold points
    std::size_t scans = 0;           ///< that were followed
    ScanSamples samples;             ///< of the last scan
    LocalMap local;
    std::shared_ptr<const Map> given;  ///< null: odometry
    std::unique_ptr<PatchTree<3>> target;
};

}  // namespace hgmm
