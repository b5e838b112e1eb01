#include "match_poses.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "files.h"
#include "match_numbers.h"
#include "match_stamps.h"
#include "name_readings.h"

namespace hgmm::importer {
namespace fs = std::filesystem;
namespace {

using Paths = std::vector<fs::path>;

std::vector<NameReading> readingsOf(const Paths& files) {
    std::vector<std::string> stems;
    for (const auto& file : files) stems.push_back(file.stem().string());
    auto readings = readNames(stems);
    if (!readings.empty()) return readings;
    for (const auto& file : files)
        if (file.stem().string().find_first_of("0123456789") == std::string::npos)
            failFile(file,
                     "the name holds no number that gives its order; rename the file, e.g. "
                     "000000" +
                         file.extension().string());
    failFile(
        files.front(),
        "this name and those beside it hold several numbers that order the files in "
        "different ways, or the same number twice; rename the files by time or number");
}

Matching matchInOrder(const Paths& files, const PoseFile& poses) {
    const Paths ordered = orderByName(files);
    if (ordered.size() != poses.poses.size())
        failFile(poses.path, "has " + std::to_string(poses.poses.size()) + " poses for " +
                                 std::to_string(ordered.size()) +
                                 " scans; --match order needs one for each");
    Matching result;
    result.order = "by order, as --match says";
    for (std::size_t i = 0; i < ordered.size(); ++i)
        result.scans.push_back(
            {ordered[i], poses.poses[i].stamp, poses.poses[i].T_world_frame});
    return result;
}

[[noreturn]] void failUnmatched(const Paths& files, const PoseFile& poses,
                                const MatchOptions& options) {
    failFile(
        poses.path,
        "its " + poses.format +
            " do not tell which pose is that of which scan: no "
            "reading of names as " +
            files.front().filename().string() + " meets the poses within " +
            std::to_string(options.tolerance_s) +
            " s, or their numbers; give poses with the stamps or numbers of the files, or "
            "say --match order if pose i belongs to file i");
}

}  // namespace

Paths orderByName(const Paths& files) {
    const auto reading = readingsOf(files).front();
    std::vector<std::size_t> order(files.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
        return reading.values[a] < reading.values[b];
    });
    Paths result;
    for (const std::size_t i : order) {
        if (!result.empty() && i != order.front()) {
            const std::size_t before = order[result.size() - 1];
            if (reading.values[before] == reading.values[i])
                failFile(files[i], "has the same " + reading.what + " in its name as " +
                                       files[before].filename().string() +
                                       "; rename one of them");
        }
        result.push_back(files[i]);
    }
    return result;
}

Matching matchPoses(const Paths& files, const PoseFile& poses,
                    const MatchOptions& options) {
    if (options.by == MatchBy::order) return matchInOrder(files, poses);
    const auto readings = readingsOf(files);
    const auto number = std::find_if(readings.begin(), readings.end(),
                                     [](const auto& reading) { return !reading.isTime; });
    const std::vector<NameReading> likelyTimes(readings.begin(), number);
    const bool byStamp = options.by != MatchBy::number && !options.firstNumber;
    const bool byNumber = options.by != MatchBy::stamp && number != readings.end();
    std::optional<Matching> matching;
    if (byStamp) matching = matchStamps(files, likelyTimes, poses, options, 1);
    if (!matching && byNumber) matching = matchNumbers(files, *number, poses, options);
    if (!matching && byStamp && number != readings.end()) {
        // Short numbers are times only if each of them meets a pose of its own, and one
        // alone would meet by chance.
        matching =
            matchStamps(files, {number + 1, readings.end()}, poses, options, files.size());
    }
    if (!matching && byNumber) matching = matchLines(files, *number, poses, options);
    if (!matching) failUnmatched(files, poses, options);
    std::stable_sort(matching->scans.begin(), matching->scans.end(),
                     [](const auto& a, const auto& b) { return a.stamp < b.stamp; });
    matching->withoutPose = files.size() - matching->scans.size();
    matching->notes.insert(matching->notes.begin(), poses.notes.begin(), poses.notes.end());
    return *matching;
}

}  // namespace hgmm::importer
