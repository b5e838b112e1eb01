#pragma once
#include <optional>
#include <vector>

#include "match_poses.h"
#include "name_readings.h"

namespace hgmm::importer {

/// Files whose number the pose file has, with that pose. Nothing if the pose file has no
/// whole numbers, or too few of those of the files. Throws std::runtime_error if the two
/// seem to count from different starts.
std::optional<Matching> matchNumbers(const std::vector<std::filesystem::path>& files,
                                     const NameReading& reading, const PoseFile& poses,
                                     const MatchOptions& options);

/// Files whose number counts the lines of the pose file: from 0 on if there is a file 0 or
/// the options say so, from 1 on if only that fits, or from the first file on if the files
/// are numbered without gaps and are as many as the lines. Nothing if the pose file has
/// numbers, or the files have stamps. Throws std::runtime_error if more than one start
/// fits, if there are too few lines, or so many stamped ones that they seem to be of
/// another rate.
std::optional<Matching> matchLines(const std::vector<std::filesystem::path>& files,
                                   const NameReading& reading, const PoseFile& poses,
                                   const MatchOptions& options);

}  // namespace hgmm::importer
