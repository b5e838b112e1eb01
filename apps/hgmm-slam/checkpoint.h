#pragma once
#include <hgmm/slam/odometry.h>
#include <hgmm/slam/submap_slam.h>
#include <mrpt/maps/CHGMMOccupancyMap.h>

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "options.h"

namespace hgmm::slam_app {

/// Where a run stopped, between two scans.
struct SavedRun {
    std::size_t scans = 0;      ///< that were followed
    std::size_t scansLost = 0;  ///< of these
    double seconds = 0.0;       ///< that they took [s]
    std::vector<std::uint8_t> odometry, slam;
};

/// The state of a run that is not finished, in a folder below that of the outputs, so that
/// the same command goes on from there. Finished submaps are files of their own, which are
/// written once; the state comes after what it needs, whole or not at all.
class Checkpoint {
 public:
    /// @param map of the run
    /// @param sensorLabel that is used
    Checkpoint(const Options& options, const mrpt::maps::CHGMMOccupancyMap& map,
               const std::optional<std::string>& sensorLabel);

    /// The run that stopped here; nothing if there is none. Throws std::runtime_error if it
    /// was given something else than this one, naming what, or cannot be read.
    std::optional<SavedRun> load();
    /// Finished submap k of it, as it was saved. Throws std::runtime_error.
    std::vector<std::uint8_t> submap(std::size_t k);

    /// Whether the last state is older than Options::saveEvery_s.
    bool isDue() const;
    /// Saves the state of both. Where that fails, a message says so, the run goes on, and
    /// false is returned.
    bool save(SavedRun run, const slam::Odometry& odometry, const slam::SubmapSlam& slam);
    /// After the run has finished, or to begin anew. Throws std::runtime_error if the state
    /// cannot be removed.
    void remove();
    const std::string& folder() const { return folder_; }

 private:
    using Clock = std::chrono::steady_clock;

    void write(const SavedRun& run, const slam::SubmapSlam& slam);
    std::string stateFile() const { return folder_ + "/state"; }
    std::string submapFile(std::size_t k) const {
        return folder_ + "/submap-" + std::to_string(k);
    }

    std::string folder_;
    /// What decides the result: what it is, as messages call it, and its value.
    std::vector<std::pair<std::string, std::string>> given_;
    /// Of each finished submap that is saved: what its file holds (contentMark).
    std::vector<std::string> marks_;
    double saveEvery_s_;
    Clock::time_point saved_ = Clock::now();
};

}  // namespace hgmm::slam_app
