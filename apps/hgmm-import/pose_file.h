#pragma once
#include <hgmm/scan.h>

#include <cstddef>
#include <string>
#include <vector>

namespace hgmm::importer {

/// What the first column of a pose file tells.
enum class PoseKey {
    none,    ///< there is none: lines are counted
    stamp,   ///< a time, or the number of a scan
    number,  ///< the number of a scan
};

/// A pose of a file, in the frame that the file speaks of.
struct RecordedPose {
    double key = 0;  ///< stamp [s] or number; the line's number from 0 on if there is none
    double stamp = 0;  ///< [s]; numbers that are no stamps are kDefaultPosePeriod apart
    Pose T_world_frame;
};

/// The poses of a file, in its own order.
struct PoseFile {
    std::string path;
    std::string format;  ///< for messages, as "TUM lines"
    PoseKey key = PoseKey::none;
    bool wholeKeys = false;  ///< keys may be numbers of scans
    bool sorted = true;      ///< keys rise
    std::vector<RecordedPose> poses;
    std::vector<std::string> notes;  ///< what was guessed, a line each
};

/// Reads a pose file of any of these kinds, told by what its first line is and how many
/// numbers it has; commas count as blanks, lines that start with # are skipped:
///
/// | numbers | meaning |
/// | --- | --- |
/// | 12, 16 | KITTI: the pose's upper three rows, or all four |
/// | 13, 17 | the same after the number of the scan |
/// | 8 | TUM: t x y z qx qy qz qw; t may be the number of the scan |
/// | 9, 10 | seconds nanoseconds x y z qx qy qz qw, in 10 after a counter |
/// | 7 | x y z qx qy qz qw |
/// | 4 | t x y z, or the number of the scan x y z; the rotation is the identity |
/// | VERTEX_SE3:QUAT, VERTEX_SE2 | g2o; other lines are skipped |
///
/// Stamps that are whole numbers too far apart for seconds are read as milli-, micro- or
/// nanoseconds, with a note. Throws std::runtime_error that names file, line and cause.
PoseFile readPoseFile(const std::string& path);

/// The poses as lines that are counted, stamped with these times.
void stampLines(const std::vector<double>& times_s, PoseFile& file);

}  // namespace hgmm::importer
