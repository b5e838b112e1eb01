#include "sources/tum.h"

#include <hgmm/evaluation/parse_numbers.h>
#include <hgmm/evaluation/trajectory.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <sstream>

#include "files.h"

namespace hgmm::importer {
namespace fs = std::filesystem;
namespace {

constexpr double kTumUnitsPerMetre = 5000;

struct StampedFile {
    double stamp = 0;
    fs::path path;
};

/// The images of an association list, in the order of time.
std::vector<StampedFile> readList(const fs::path& list) {
    std::istringstream lines(readBytes(list));
    std::vector<StampedFile> files;
    std::size_t number = 0;
    for (std::string line; std::getline(lines, line);) {
        ++number;
        std::istringstream words(line);
        std::string time, name;
        words >> time >> name;
        if (time.empty() || time[0] == '#') continue;
        try {
            if (name.empty()) throw std::runtime_error("expected `time file`");
            files.push_back(
                {evaluation::parseNumbers(time).at(0), list.parent_path() / name});
        } catch (const std::runtime_error& e) {
            failFile(list, "line " + std::to_string(number) + ": " + e.what());
        }
    }
    if (files.empty()) failFile(list, "lists no images; give the recording's folder");
    std::stable_sort(files.begin(), files.end(),
                     [](const auto& a, const auto& b) { return a.stamp < b.stamp; });
    return files;
}

std::optional<fs::path> nearestInTime(const std::vector<StampedFile>& files, double stamp,
                                      double tolerance_s) {
    const auto nearest =
        std::min_element(files.begin(), files.end(), [&](const auto& a, const auto& b) {
            return std::abs(a.stamp - stamp) < std::abs(b.stamp - stamp);
        });
    if (nearest == files.end() || std::abs(nearest->stamp - stamp) > tolerance_s)
        return std::nullopt;
    return nearest->path;
}

/// The benchmark's published calibrations of its three colour cameras.
Intrinsics intrinsicsByName(const std::string& folder) {
    const fs::path whole = fs::weakly_canonical(folder);
    const std::string name =
        (whole.has_filename() ? whole : whole.parent_path()).filename();
    const auto has = [&](const std::string& camera) {
        return name.find("fr" + camera) != std::string::npos ||
               name.find("freiburg" + camera) != std::string::npos;
    };
    if (has("1")) return {517.3, 516.5, 318.6, 255.3};
    if (has("2")) return {520.9, 521.0, 325.1, 249.7};
    if (has("3")) return {535.4, 539.2, 320.1, 247.6};
    failFile(folder,
             "the name does not tell which camera it is (fr1, fr2 or fr3); give "
             "--intrinsics fx,fy,cx,cy");
}

}  // namespace

TumSource::TumSource(const std::string& folder, const RgbdOptions& options) {
    const fs::path root(folder);
    if (!fs::is_directory(root))
        failFile(root, "is no folder; give the recording's folder");
    camera_ = options.intrinsics ? *options.intrinsics : intrinsicsByName(folder);
    format_.metresPerUnit =
        static_cast<float>(1 / options.unitsPerMetre.value_or(kTumUnitsPerMetre));
    const auto depths = readList(root / "depth.txt");
    const fs::path colorList = root / "rgb.txt";
    const auto colors =
        fs::exists(colorList) ? readList(colorList) : std::vector<StampedFile>{};
    const fs::path poseFile = root / "groundtruth.txt";
    const auto poses = evaluation::readTrajectory(poseFile.string());
    summary_.files = {root / "depth.txt", colorList, poseFile};
    for (const auto* list : {&depths, &colors})
        for (const auto& image : *list) summary_.files.push_back(image.path);
    const double tolerance_s = options.tolerance_s;
    for (const auto& [stamp, path] : depths)
        if (const auto pose = evaluation::poseAt(poses, stamp, tolerance_s))
            frames_.push_back(
                {{path, nearestInTime(colors, stamp, tolerance_s)}, stamp, *pose});
    char within[60];
    std::snprintf(within, sizeof within, "within %g ms", 1e3 * tolerance_s);
    const std::string counts = "has a pose " + std::string(within) + " for " +
                               std::to_string(frames_.size()) + " of " +
                               std::to_string(depths.size()) + " depth images";
    if (frames_.empty()) failFile(poseFile, counts + "; give the poses of this recording");
    if (frames_.size() < depths.size())
        summary_.notes.push_back(poseFile.string() + ": " + counts +
                                 "; the others are left out");
    summary_.order = "by stamp (poses " + std::string(within) + ", interpolated)";
    summary_.withoutPose = depths.size() - frames_.size();
    summary_.scale = describeScale(options, kTumUnitsPerMetre);
    summary_.expectedRange = depthCameraRange(options.unitsPerMetre.has_value());
}

ImportedScan TumSource::load(std::size_t index) const {
    const Frame& frame = frames_.at(index);
    ImportedScan scan;
    scan.observation = makeRgbdObservation(frame.images, camera_, format_);
    scan.stamp = frame.stamp;
    scan.T_world_robot = frame.T_world_optical;
    return scan;
}

}  // namespace hgmm::importer
