#pragma once
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <vector>

#include "hgmm/export.h"
#include "hgmm/map.h"
#include "hgmm/params.h"
#include "hgmm/registration.h"
#include "hgmm/scan.h"

namespace hgmm {

/// How a sensor is followed (ScanTracker).
struct TrackerParams {
    /// How far off the first prior may be, one standard deviation [m], in [1e-3, 1e3].
    double firstDeviation_m = 0.5;
    double firstDeviation_rad = 0.2;  ///< of its rotation [rad], in [1e-4, 1]
    int maxSamples = 2000;  ///< of a scan, evenly spread, that are aligned [count], >= 50
    double minOverlap = 0.12;  ///< with less on surfaces, the sensor is lost [1], in (0, 1]
    /// Odometry enters a scan into its map when the sensor has moved so far since the last
    /// one [m],
    double insertEvery_m = 0.1;     ///< in [0, 1e3]
    double insertEvery_rad = 0.05;  ///< or has turned so far [rad], in [0, 7]
    /// Odometry begins a new map when the sensor is so far from where the map began [m],
    /// in [1, 1e6]. It takes over the scans of the last quarter of this way, at most 300.
    double mapRadius_m = 100.0;

    /// Throws std::invalid_argument naming the field.
    HGMM_EXPORT void validate() const;
};

/// A pose and how sure it is.
struct PoseEstimate {
    Pose T_map_sensor;
    /// Of the error (w, v), rotation [rad] before translation [m], both in the axes of the
    /// map: truth = { exp(w) R, t + v }, as in Registration. Positive definite.
    Registration::Covariance covariance = Registration::Covariance::Identity() * 1e-6;
};

/// How the sensor moved since the last scan, by odometry.
struct MotionIncrement {
    Pose T_last_now;  ///< of the sensor
    /// Of its error, as in PoseEstimate, in the axes of the last pose. Positive definite.
    Registration::Covariance covariance = Registration::Covariance::Identity() * 1e-6;
};

/// Where the sensor is.
struct TrackedPose : PoseEstimate {
    double overlap = 0.0;  ///< share of the scan's samples that lie on a surface, [0, 1]
    double contradicted = 0.0;  ///< share of them in space known to be free, [0, 1]
    int observable = 0;         ///< directions that the surfaces hold [count], 0 to 6
    bool lost = false;          ///< the pose is the prior's: the scan says nothing of it
    bool inserted = false;      ///< the scan is in the map; odometry only
};

/// Follows one sensor from scan to scan, by aligning each scan's samples with the surfaces
/// of a map: its own, which it builds as it goes (odometry), or a given one (localisation).
///
/// The prior is the last pose moved on by odometry, where there is some, or else at
/// constant velocity. How far the prior was off before decides how far the alignment looks
/// (the adaptive threshold of KISS-ICP, Vizzo et al. 2023). Directions that the surfaces do
/// not hold are left to the prior, whose covariance grows there. Planar lasers move in
/// their plane only. Where little of a scan is found, or some of it where space is known to
/// be free, or the pose is far from the prior, mixtures are registered
/// (RegistrationTarget), which looks farther. If that leaves doubt, odometry looks for the
/// sensor in all headings about the map's z axis, as far as half of the scan reaches.
/// Where nothing fits, the sensor is lost. Odometry that is lost for five scans goes on
/// from the prior in a new map.
///
/// The same input gives the same poses for any number of threads. Not for concurrent use.
class HGMM_EXPORT ScanTracker {
 public:
    /// Odometry, in a map of its own. The first scan is at `start`.
    /// Throws std::invalid_argument for params out of range or a start that is not rigid or
    /// whose covariance is not positive definite.
    explicit ScanTracker(const MapParams& mapParams = {}, const TrackerParams& params = {},
                         const PoseEstimate& start = {});
    /// Localisation in a map that does not change. The first scan is about at `start`.
    /// Throws std::invalid_argument for params out of range, a null or empty map, or a
    /// start as above.
    ScanTracker(std::shared_ptr<const Map> map, const PoseEstimate& start,
                const TrackerParams& params = {});
    ScanTracker(ScanTracker&&) noexcept;
    ScanTracker& operator=(ScanTracker&&) noexcept;
    ~ScanTracker();

    /// Follows the sensor to the next scan, whose T_map_sensor is not used.
    /// @param time_s when the pose holds [s], of any epoch; later than the last
    /// @param odometry since the last scan; constant velocity without it
    /// @param pointTimes_s when each point was measured, after time_s [s], may be negative:
    /// the sensor's motion is taken out of the scan. Empty: all points at time_s.
    /// Throws std::invalid_argument for a malformed scan (Scan::validate), a time that is
    /// not finite or earlier than the last, odometry that is not rigid, or another number
    /// of times than of points. Nothing is changed then.
    TrackedPose track(const Scan& scan, double time_s,
                      const std::optional<MotionIncrement>& odometry = std::nullopt,
                      const std::vector<float>& pointTimes_s = {});

    /// The state of odometry, from which another process can go on: all that later poses
    /// depend on, bit for bit, but for what the caller can make again, samples of scans.
    /// For the same version of the library. Throws std::logic_error for localisation in a
    /// given map.
    std::vector<std::uint8_t> save() const;
    /// Odometry that goes on from save(): the poses that follow are those of the saved one.
    /// @param samplesOfScan tells what lastSamples() was after a scan, counted from 0 in
    /// the order of track(); it is asked for some hundred at most, in rising order, the
    /// last scan at the end
    /// Throws FormatError for another buffer, and what samplesOfScan throws.
    static ScanTracker load(
        const std::uint8_t* data, std::size_t size,
        const std::function<ScanSamples(std::size_t scan)>& samplesOfScan);

    /// The map: its own so far, or the given one.
    const Map& map() const;
    /// What became of the last scan, motion taken out: samplesOf. For other maps of the
    /// same parameters.
    const ScanSamples& lastSamples() const;

 private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

}  // namespace hgmm
