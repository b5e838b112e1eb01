#pragma once
#include <optional>

#include "hgmm/mrpt_bridge/output_file.h"
#include "hgmm/tracker.h"
#include "options.h"

namespace localise {

/// Where poses go: rows to stdout at once, files when the run ends.
class PoseOutputs {
 public:
    /// Throws std::runtime_error where an output cannot be written, or would replace an
    /// input or a file of another kind.
    explicit PoseOutputs(const Options& options);

    /// @param pose nothing: the robot is not found yet
    void add(double time_s, const std::optional<hgmm::TrackedPose>& pose);
    /// Puts the files in their places, all or none.
    void commit();

 private:
    void addRow(const std::string& row);

    bool print_;
    std::optional<hgmm::mrpt_bridge::OutputFile> trajectory_, table_;
};

}  // namespace localise
