#pragma once
#include <hgmm/evaluation/recording.h>
#include <hgmm/evaluation/trajectory.h>
#include <hgmm/mrpt_bridge/reading_params.h>
#include <hgmm/slam/submap_slam.h>

#include <memory>

#include "checkpoint.h"
#include "options.h"

namespace hgmm::slam_app {

/// A recording that was followed.
struct SlamRun {
    std::unique_ptr<slam::SubmapSlam> slam;  ///< finished
    evaluation::Trajectory trajectory;       ///< T_world_robot of each scan, in their order
    slam::Continuation continuation;         ///< of an earlier map
    std::size_t scansLost = 0;
    double seconds = 0.0;  ///< that it took [s]
    bool interrupted = false;
    bool canGoOn = false;  ///< its state was saved where it was interrupted
};

/// Opens the recording of the options, with poses to be followed if it has some, and says
/// which of several sensors is used. Throws std::runtime_error naming the file.
evaluation::RecordingOptions recordingOptionsFor(const Options& options);

/// Follows the recording to its end or Ctrl-C, from the checkpoint's state if it has one.
/// Throws as Checkpoint::load does.
SlamRun runSlam(evaluation::Recording& recording, const MapParams& map,
                const mrpt_bridge::ReadingParams& reading, const Options& options,
                Checkpoint& checkpoint);

}  // namespace hgmm::slam_app
