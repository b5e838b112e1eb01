#pragma once
#include <hgmm/scan.h>
#include <mrpt/obs/CObservation.h>

#include <cstddef>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "expected_range.h"

namespace hgmm::importer {

/// One scan of a recording, in MRPT's terms.
struct ImportedScan {
    mrpt::obs::CObservation::Ptr observation;  ///< sensorPose set, time stamp not yet
    double stamp = 0;                          ///< [s], of the recording's own epoch
    Pose T_world_robot;                        ///< where the frame of sensorPose was
    std::size_t droppedPoints = 0;  ///< points without a return, or not finite, left out
    std::vector<std::string> usedFields, unusedFields;  ///< of the file, if it has any
};

/// What a source can say of how it reads a recording.
struct SourceSummary {
    std::vector<std::string> notes;  ///< how files and poses were matched; a line each
    std::string order;               ///< what told the poses of scans
    std::string scale;               ///< of lengths and channels; empty: nothing to say
    std::size_t withoutPose = 0;     ///< scans left out because they have no pose
    ExpectedRange expectedRange;
    std::vector<std::filesystem::path> files;  ///< all that are read from a folder
};

/// A recording on disk. Constructors look at the folder and the pose file, and load() at
/// one scan; both throw std::runtime_error that names the file, what is wrong and what to
/// do.
class Source {
 public:
    virtual ~Source() = default;

    /// How many scans have a pose.
    virtual std::size_t size() const = 0;
    /// Reads through the recording for what one scan does not tell, before the first
    /// load().
    virtual void prepare() {}
    /// Scan number index, in [0, size()), in the order of time.
    virtual ImportedScan load(std::size_t index) const = 0;
    const SourceSummary& summary() const { return summary_; }

 protected:
    SourceSummary summary_;
};

}  // namespace hgmm::importer
