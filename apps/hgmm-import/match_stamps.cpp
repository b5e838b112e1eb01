#include "match_stamps.h"

#include <hgmm/evaluation/trajectory.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <set>

#include "files.h"

namespace hgmm::importer {
namespace {

using evaluation::Trajectory;
using Index = std::ptrdiff_t;

/// The nearest pose of each file, by number in the trajectory, or -1.
struct Meeting {
    std::vector<Index> poseOfFile;
    std::size_t poses = 0;     ///< different ones that are met
    std::size_t possible = 0;  ///< that could be met where both have something
};

Trajectory byTime(const PoseFile& file) {
    Trajectory trajectory;
    for (const auto& pose : file.poses)
        trajectory.push_back({pose.stamp, pose.T_world_frame});
    std::stable_sort(trajectory.begin(), trajectory.end(),
                     [](const auto& a, const auto& b) { return a.stamp < b.stamp; });
    return trajectory;
}

Index nearest(const Trajectory& poses, double stamp) {
    const auto after =
        std::lower_bound(poses.begin(), poses.end(), stamp,
                         [](const auto& pose, double t) { return pose.stamp < t; });
    if (after == poses.begin()) return 0;
    if (after == poses.end() || stamp - (after - 1)->stamp < after->stamp - stamp)
        return after - poses.begin() - 1;
    return after - poses.begin();
}

Meeting meet(const std::vector<double>& stamps, const Trajectory& poses,
             double tolerance_s) {
    Meeting meeting;
    std::set<Index> met;
    std::size_t filesWithin = 0;
    const auto [first, last] = std::minmax_element(stamps.begin(), stamps.end());
    for (const double stamp : stamps) {
        if (stamp >= poses.front().stamp - tolerance_s &&
            stamp <= poses.back().stamp + tolerance_s)
            ++filesWithin;
        const Index i = nearest(poses, stamp);
        const double gap = std::abs(poses[static_cast<std::size_t>(i)].stamp - stamp);
        meeting.poseOfFile.push_back(gap <= tolerance_s ? i : -1);
        if (gap <= tolerance_s) met.insert(i);
    }
    const double from = *first - tolerance_s, to = *last + tolerance_s;
    const auto posesWithin = static_cast<std::size_t>(std::count_if(
        poses.begin(), poses.end(),
        [&](const auto& pose) { return pose.stamp >= from && pose.stamp <= to; }));
    meeting.poses = met.size();
    meeting.possible = std::min(filesWithin, posesWithin);
    return meeting;
}

void requireOnePose(const Trajectory& poses, Index i, const PoseFile& file) {
    const auto at = static_cast<std::size_t>(i);
    for (const std::size_t other : {at - 1, at + 1}) {
        if (other >= poses.size() || poses[other].stamp != poses[at].stamp) continue;
        const Pose &a = poses[at].T_world_frame, &b = poses[other].T_world_frame;
        if (a.t != b.t || a.R != b.R)
            failFile(file.path, "has two different poses with the stamp " +
                                    std::to_string(poses[at].stamp) + "; remove one");
    }
}

std::string seconds(double s) {
    char text[40];
    std::snprintf(text, sizeof text, "%g s", s);
    return text;
}

}  // namespace

std::optional<Matching> matchStamps(const std::vector<std::filesystem::path>& files,
                                    const std::vector<NameReading>& readings,
                                    const PoseFile& file, const MatchOptions& options,
                                    std::size_t leastPoses) {
    if (file.key != PoseKey::stamp) return std::nullopt;
    const Trajectory poses = byTime(file);
    const NameReading* best = nullptr;
    Meeting bestMeeting;
    for (const auto& reading : readings) {
        const Meeting meeting = meet(reading.values, poses, options.tolerance_s);
        if (meeting.poses < leastPoses || 2 * meeting.poses < meeting.possible) continue;
        if (best && meeting.poses == bestMeeting.poses &&
            meeting.poseOfFile != bestMeeting.poseOfFile)
            failFile(files.front(), "the names can be read as " + best->what + " and as " +
                                        reading.what +
                                        ", and both meet stamps of the poses; rename the "
                                        "files, or give --tolerance");
        if (best && meeting.poses <= bestMeeting.poses) continue;
        best = &reading;
        bestMeeting = meeting;
    }
    if (!best) return std::nullopt;
    Matching result;
    std::set<double> taken;
    for (std::size_t i = 0; i < files.size(); ++i) {
        const Index nearestPose = bestMeeting.poseOfFile[i];
        if (nearestPose < 0) continue;
        requireOnePose(poses, nearestPose, file);
        const double stamp = best->values[i];
        if (!taken.insert(stamp).second)
            failFile(files[i], "another file has the same time in its name; remove one");
        result.scans.push_back(
            {files[i], stamp, *evaluation::poseAt(poses, stamp, options.tolerance_s)});
    }
    result.order = "by stamp (names are " + best->what + ", poses within " +
                   seconds(options.tolerance_s) + ")";
    return result;
}

}  // namespace hgmm::importer
