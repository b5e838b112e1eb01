#pragma once
#include <hgmm/scan.h>
#include <mrpt/obs/CObservation.h>

#include <cstddef>
#include <memory>
#include <string>
#include <vector>

namespace hgmm::importer {

/// One scan of a recording, in MRPT's terms.
struct ImportedScan {
    mrpt::obs::CObservation::Ptr observation;  ///< sensorPose set, time stamp not yet
    double stamp = 0;                          ///< [s], of the recording's own epoch
    Pose T_world_robot;                        ///< where the frame of sensorPose was
    std::size_t droppedPoints = 0;  ///< points without a return, or not finite, left out
};

/// A recording on disk. Constructors look at the folder and the pose file, and load() at
/// one scan; both throw std::runtime_error that names the file, what is wrong and what to
/// do.
class Source {
 public:
    virtual ~Source() = default;

    /// How many scans have a pose.
    virtual std::size_t size() const = 0;
    /// Scan number index, in [0, size()), in the order of time.
    virtual ImportedScan load(std::size_t index) const = 0;
    /// What the user should know of how files and poses were matched; one line each.
    const std::vector<std::string>& notes() const { return notes_; }

 protected:
    std::vector<std::string> notes_;
};

}  // namespace hgmm::importer
