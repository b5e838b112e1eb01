#pragma once
#include <optional>
#include <vector>

#include "match_poses.h"
#include "name_readings.h"

namespace hgmm::importer {

/// Files that have a pose within the tolerance of the time in their names, with the pose at
/// that time. Of the readings, the one that meets the most poses counts. Nothing if the
/// poses have no stamps, or if fewer than half of the files (or of the poses, if they are
/// fewer) in the time that both cover meet, or fewer than leastPoses are met. Throws
/// std::runtime_error if two readings meet equally many poses and differ, or if the file
/// has two poses for the time of a scan.
std::optional<Matching> matchStamps(const std::vector<std::filesystem::path>& files,
                                    const std::vector<NameReading>& readings,
                                    const PoseFile& poses, const MatchOptions& options,
                                    std::size_t leastPoses);

}  // namespace hgmm::importer
