#include "sources/seven_scenes.h"

#include <hgmm/evaluation/parse_numbers.h>
#include <hgmm/evaluation/trajectory.h>

#include "files.h"

namespace hgmm::importer {
namespace fs = std::filesystem;
namespace {

constexpr double kFramesPerSecond = 30;
constexpr double kSevenScenesUnitsPerMetre = 1000;
constexpr std::uint16_t kInvalidDepth = 65535;
const std::string kDepthSuffix = ".depth.png";

std::vector<double> readMatrix(const fs::path& file, std::size_t count) {
    const std::string text = readBytes(file);
    std::vector<double> numbers;
    try {
        numbers = evaluation::parseNumbers(text);
    } catch (const std::runtime_error& e) {
        failFile(file, e.what());
    }
    if (numbers.size() != count)
        failFile(file, "expected " + std::to_string(count) + " numbers, got " +
                           std::to_string(numbers.size()));
    return numbers;
}

Pose readPose(const fs::path& file) {
    const auto m = readMatrix(file, 16);
    Pose pose;
    pose.R << m[0], m[1], m[2], m[4], m[5], m[6], m[8], m[9], m[10];
    pose.t = {m[3], m[7], m[11]};
    try {
        pose.R = evaluation::nearestRotation(pose.R);
    } catch (const std::runtime_error& e) {
        failFile(file, std::string(e.what()) + "; remove the frame");
    }
    return pose;
}

Intrinsics readIntrinsics(const fs::path& file) {
    const auto m = readMatrix(file, 9);
    if (m[0] <= 0 || m[4] <= 0) failFile(file, "the focal lengths must be positive");
    return {m[0], m[4], m[2], m[5]};
}

std::optional<fs::path> findColor(const std::string& stem) {
    for (const char* suffix : {".color.jpg", ".color.png"})
        if (fs::exists(stem + suffix)) return stem + suffix;
    return std::nullopt;
}

}  // namespace

SevenScenesSource::SevenScenesSource(const std::string& folder, const RgbdOptions& options)
    : camera_{585, 585, 320, 240} {
    std::string firstProblem;
    for (const auto& [path, number] : listNumberedFiles(folder, kDepthSuffix)) {
        const std::string name = path.string();
        const std::string stem = name.substr(0, name.size() - kDepthSuffix.size());
        try {
            const fs::path poseFile = stem + ".pose.txt";
            summary_.files.push_back(path);
            summary_.files.push_back(poseFile);
            if (!fs::exists(poseFile))
                failFile(poseFile, "is missing; each depth image needs its pose");
            frames_.push_back({{path, findColor(stem)},
                               static_cast<double>(number) / kFramesPerSecond,
                               readPose(poseFile)});
        } catch (const std::runtime_error& e) {
            if (firstProblem.empty()) firstProblem = e.what();
            ++summary_.withoutPose;
        }
    }
    if (frames_.empty()) throw std::runtime_error(firstProblem);
    if (!firstProblem.empty())
        summary_.notes.push_back(firstProblem + " (" +
                                 std::to_string(summary_.withoutPose) +
                                 " frames without a pose are left out)");
    for (const Frame& frame : frames_)
        if (frame.images.color) summary_.files.push_back(*frame.images.color);
    const fs::path intrinsicsFile = fs::path(folder) / "camera-intrinsics.txt";
    summary_.files.push_back(intrinsicsFile);
    if (options.intrinsics)
        camera_ = *options.intrinsics;
    else if (fs::exists(intrinsicsFile))
        camera_ = readIntrinsics(intrinsicsFile);
    format_.alsoInvalid = kInvalidDepth;
    format_.metresPerUnit =
        static_cast<float>(1 / options.unitsPerMetre.value_or(kSevenScenesUnitsPerMetre));
    summary_.order = "by number";
    summary_.scale = describeScale(options, kSevenScenesUnitsPerMetre);
    summary_.expectedRange = depthCameraRange(options.unitsPerMetre.has_value());
}

ImportedScan SevenScenesSource::load(std::size_t index) const {
    const Frame& frame = frames_.at(index);
    ImportedScan scan;
    scan.observation = makeRgbdObservation(frame.images, camera_, format_);
    scan.stamp = frame.stamp;
    scan.T_world_robot = frame.T_world_optical;
    return scan;
}

}  // namespace hgmm::importer
