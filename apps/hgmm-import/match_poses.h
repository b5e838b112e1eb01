#pragma once
#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "pose_file.h"

namespace hgmm::importer {

/// What tells the pose of a scan.
enum class MatchBy { automatic, stamp, number, order };

/// How scans and poses are brought together.
struct MatchOptions {
    MatchBy by = MatchBy::automatic;
    /// Number of the scan that the first line of a pose file without numbers belongs to;
    /// otherwise told by names and counts, and refused if they do not tell.
    std::optional<double> firstNumber;
    bool countsFromZero = false;  ///< the format says that line N (from 0) is of file N
    double tolerance_s = 0.02;  ///< most between a scan's stamp and the nearest pose's [s]
};

/// A file with its time and pose.
struct PosedFile {
    std::filesystem::path path;
    double stamp = 0;  ///< [s]
    Pose T_world_frame;
};

/// Scans with poses, in the order of time.
struct Matching {
    std::vector<PosedFile> scans;
    std::size_t withoutPose = 0;     ///< scans left out
    std::string order;               ///< what told the poses, for the closing line
    std::vector<std::string> notes;  ///< what the user should know, a line each
};

/// Files whose names order them without doubt, in that order. Throws std::runtime_error
/// that names a file otherwise.
std::vector<std::filesystem::path> orderByName(const std::vector<std::filesystem::path>&);

/// The pose of each file by its stamp (interpolated) or its number; never by its place,
/// unless the options say so. Files without a pose are left out and counted. Throws
/// std::runtime_error that says what is in doubt if names and poses can be brought together
/// in more than one way, or in none.
Matching matchPoses(const std::vector<std::filesystem::path>& files, const PoseFile& poses,
                    const MatchOptions& options);

}  // namespace hgmm::importer
