#pragma once
#include <mrpt/io/CFileGZInputStream.h>
#include <mrpt/obs/CObservation.h>
#include <mrpt/poses/CPose3D.h>

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

namespace equality {

/// An observation and where the robot was.
struct RecordedScan {
    mrpt::obs::CObservation::Ptr observation;
    mrpt::poses::CPose3D T_map_robot;
};

/// A recording as hgmm-import writes it: a rawlog of observations, and a line of poses for
/// each.
class Recording {
 public:
    /// Throws std::runtime_error naming the file that cannot be read.
    Recording(const std::string& rawlogFile, const std::string& posesFile);

    std::size_t size() const { return T_map_robot_.size(); }  ///< [scans]
    /// The next scan; nothing after the last. Throws if the rawlog ends before the poses.
    std::optional<RecordedScan> next();

 private:
    mrpt::io::CFileGZInputStream rawlog_;
    std::vector<mrpt::poses::CPose3D> T_map_robot_;
    std::size_t index_ = 0;
};

}  // namespace equality
