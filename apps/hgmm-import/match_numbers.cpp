#include "match_numbers.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include "files.h"

namespace hgmm::importer {
namespace {

namespace fs = std::filesystem;
using NumberSet = std::set<double>;

std::string wholeText(double number) {
    return std::to_string(static_cast<long long>(number));
}

std::size_t common(const NumberSet& files, const NumberSet& poses, double shift) {
    return static_cast<std::size_t>(
        std::count_if(files.begin(), files.end(),
                      [&](double number) { return poses.count(number + shift) > 0; }));
}

/// NumberSet of one set within the range of the other.
std::size_t within(const NumberSet& inner, const NumberSet& outer) {
    return static_cast<std::size_t>(std::distance(inner.lower_bound(*outer.begin()),
                                                  inner.upper_bound(*outer.rbegin())));
}

bool isContiguous(const NumberSet& numbers) {
    return *numbers.rbegin() - *numbers.begin() + 1 == static_cast<double>(numbers.size());
}

/// The numbers in names, and what they are to be matched with.
struct Numbered {
    const std::vector<fs::path>& files;
    const NameReading& reading;
    const PoseFile& poses;
    const MatchOptions& options;
    NumberSet fileNumbers;

    std::string counts() const {
        return std::to_string(poses.poses.size()) + " poses for the " +
               std::to_string(files.size()) + " " + files.front().extension().string() +
               " files of " + files.front().parent_path().string();
    }
    double lines() const { return static_cast<double>(poses.poses.size()); }
};

/// Files and poses of the same number.
std::optional<Matching> matchKeys(const Numbered& all) {
    std::map<double, const RecordedPose*> poseOf;
    NumberSet keys;
    for (const auto& pose : all.poses.poses) {
        const auto [place, isNew] = poseOf.emplace(pose.key, &pose);
        keys.insert(pose.key);
        if (isNew) continue;
        const Pose &a = place->second->T_world_frame, &b = pose.T_world_frame;
        if (a.t != b.t || a.R != b.R)
            failFile(all.poses.path, "has two different poses with the number " +
                                         wholeText(pose.key) + "; remove one");
    }
    const std::size_t met = common(all.fileNumbers, keys, 0);
    const std::size_t shifted =
        std::max(common(all.fileNumbers, keys, 1), common(all.fileNumbers, keys, -1));
    const bool wanted = all.options.by == MatchBy::number;
    const bool onlyPair = all.files.size() == 1 && keys.size() == 1;
    if (shifted > met && !wanted && !onlyPair)
        failFile(all.poses.path,
                 "its numbers " + wholeText(*keys.begin()) + " to " +
                     wholeText(*keys.rbegin()) + " and those of the files, " +
                     wholeText(*all.fileNumbers.begin()) + " to " +
                     wholeText(*all.fileNumbers.rbegin()) +
                     ", seem to count from different starts; say --first-number N if its "
                     "first line belongs to file N, or --match number if equal numbers "
                     "belong together");
    const std::size_t possible =
        std::min(within(all.fileNumbers, keys), within(keys, all.fileNumbers));
    if (met == 0 || 2 * met < possible) return std::nullopt;
    const bool oneHasAll = met == all.fileNumbers.size() || met == keys.size();
    if (!oneHasAll && !wanted && all.poses.key == PoseKey::stamp &&
        keys.size() == all.files.size() && isContiguous(all.fileNumbers))
        failFile(all.poses.path,
                 "has " + all.counts() +
                     ", and its first column may be times or numbers of files; say --match "
                     "number if they are numbers, or --first-number N if its first line "
                     "belongs to file N");
    Matching result;
    result.order = "by number";
    for (std::size_t i = 0; i < all.files.size(); ++i) {
        const auto pose = poseOf.find(all.reading.values[i]);
        if (pose != poseOf.end())
            result.scans.push_back(
                {all.files[i], pose->second->stamp, pose->second->T_world_frame});
    }
    return result;
}

/// The number of the file that the first line belongs to.
double firstNumber(const Numbered& all) {
    if (all.options.firstNumber) return *all.options.firstNumber;
    const double least = *all.fileNumbers.begin(), most = *all.fileNumbers.rbegin();
    if (isContiguous(all.fileNumbers) &&
        all.lines() == static_cast<double>(all.files.size()))
        return least;
    if (least == 0 || all.options.countsFromZero) return 0;
    if (most < all.lines())
        failFile(all.poses.path,
                 "has " + all.counts() + ", whose numbers are " + wholeText(least) +
                     " to " + wholeText(most) +
                     ": it is not told whether its first line belongs to file 0 or 1; say "
                     "--first-number 0 or --first-number 1");
    return 1;
}

/// Files and lines, counted from the first number on.
Matching countLines(const Numbered& all) {
    const double first = firstNumber(all);
    const double needed = *all.fileNumbers.rbegin() - first + 1;
    if (*all.fileNumbers.begin() < first)
        failFile(all.files.front(), "there are files before number " + wholeText(first) +
                                        ", that of the first pose; correct --first-number");
    if (needed > all.lines())
        failFile(all.poses.path,
                 "has only " + all.counts() +
                     ", and nothing tells to which they belong; give a file with one pose "
                     "for each up to number " +
                     wholeText(*all.fileNumbers.rbegin()) +
                     ", or one with numbers or stamps");
    const bool stamped = all.poses.key == PoseKey::stamp;
    if (stamped && !all.poses.sorted)
        failFile(all.poses.path, "its time stamps go back; sort the file");
    constexpr double mostUnused = 0.5;
    const bool told = all.options.firstNumber || all.options.by == MatchBy::number;
    if (stamped && !told && all.lines() > (1 + mostUnused) * needed)
        failFile(all.poses.path,
                 "has " + all.counts() +
                     ": they may be of other times than the scans; say --match number if "
                     "line N is the pose of file N");
    Matching result;
    result.order =
        "by number (line 1 of the poses is that of scan " + wholeText(first) + ")";
    if (all.lines() > needed || all.poses.poses.size() > all.files.size())
        result.notes.push_back(all.poses.path + ": has " + all.counts() +
                               "; each scan takes the pose of its number");
    for (std::size_t i = 0; i < all.files.size(); ++i) {
        const auto& pose =
            all.poses.poses[static_cast<std::size_t>(all.reading.values[i] - first)];
        result.scans.push_back({all.files[i], pose.stamp, pose.T_world_frame});
    }
    return result;
}

Numbered numbered(const std::vector<fs::path>& files, const NameReading& reading,
                  const PoseFile& poses, const MatchOptions& options) {
    Numbered all{files, reading, poses, options, {}};
    for (std::size_t i = 0; i < files.size(); ++i)
        if (!all.fileNumbers.insert(reading.values[i]).second)
            failFile(files[i], "another file has the number " +
                                   wholeText(reading.values[i]) +
                                   " in its name, too; rename one of them");
    return all;
}

}  // namespace

std::optional<Matching> matchNumbers(const std::vector<fs::path>& files,
                                     const NameReading& reading, const PoseFile& poses,
                                     const MatchOptions& options) {
    if (!poses.wholeKeys || poses.key == PoseKey::none || options.firstNumber)
        return std::nullopt;
    return matchKeys(numbered(files, reading, poses, options));
}

std::optional<Matching> matchLines(const std::vector<fs::path>& files,
                                   const NameReading& reading, const PoseFile& poses,
                                   const MatchOptions& options) {
    const bool hasNumbers = poses.key == PoseKey::number && !options.firstNumber;
    const double most = *std::max_element(reading.values.begin(), reading.values.end());
    constexpr double mostScans = 1e8;
    if (hasNumbers || most >= mostScans) return std::nullopt;
    return countLines(numbered(files, reading, poses, options));
}

}  // namespace hgmm::importer
