#pragma once
#include <cstddef>
#include <cstdint>
#include <random>
#include <vector>

#include "hgmm/slam/submap_slam.h"
#include "worlds.h"

namespace hgmm::slam_studies {

/// Where a robot truly was at each scan, and what its odometry says.
struct Drive {
    std::vector<Pose> truth;
    std::vector<double> time_s;
    std::vector<Pose> odometry;  ///< or empty: none
};

/// Straight from point to point, turns on the spot: 1 m/s and 0.8 rad/s, a scan every
/// `step_m` or 6 deg.
Drive driveAlong(const Waypoints& way, double step_m);

/// How wrong the odometry of a drive is, by the same share throughout, beside its noise.
struct OdometryError {
    double shiftShare = 0.0, turnShare = 0.0;
};
void giveOdometry(Drive& drive, const OdometryError& error, std::mt19937_64& random);

/// Without the scans of some seconds.
void leaveOut(Drive& drive, std::size_t from, double seconds);
/// Without a share of all scans but the first.
void leaveOut(Drive& drive, double share, std::mt19937_64& random);
/// From scan `at` on the robot is where it would be at scan `to`, and drives on from there;
/// odometry does not notice that it was carried.
void carryAway(Drive& drive, std::size_t at, std::size_t to);

/// What became of a drive.
struct Run {
    std::vector<Pose> found;          ///< the trajectory
    std::vector<bool> lost;           ///< scans
    std::vector<std::size_t> submap;  ///< of each scan
    slam::PoseGraph graph;
    std::size_t closures = 0, falseClosures = 0, parts = 0, lostScans = 0;
    double way_m = 0.0;
    double endError_m = 0.0;  ///< from the start on
    /// Largest error within a part, from its first pose on, without lost scans [m]. What is
    /// not said to be a guess must be right.
    double worstInPart_m = 0.0;
};

Run run(const Scene& scene, const SimulatedSensor& sensor, const Drive& drive,
        std::uint64_t seed);

/// What a sensor sees along some poses, as a submap in the frame of the first.
slam::FinishedSubmap submapAlong(const Scene& scene, const SimulatedSensor& sensor,
                                 const std::vector<Pose>& truth, std::uint64_t seed);

}  // namespace hgmm::slam_studies
