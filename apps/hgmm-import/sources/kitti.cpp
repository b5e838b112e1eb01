#include "sources/kitti.h"

#include <hgmm/evaluation/parse_numbers.h>
#include <hgmm/evaluation/trajectory.h>

#include <cstring>
#include <sstream>

#include "files.h"

namespace hgmm::importer {
namespace fs = std::filesystem;
namespace {

Pose parseTransform(const fs::path& file, const std::string& text) {
    Pose pose;
    try {
        const auto v = evaluation::parseNumbers(text);
        if (v.size() != 12)
            throw std::runtime_error("its Tr line has " + std::to_string(v.size()) +
                                     " numbers, not 12");
        pose.R << v[0], v[1], v[2], v[4], v[5], v[6], v[8], v[9], v[10];
        pose.R = evaluation::nearestRotation(pose.R);
        pose.t = {v[3], v[7], v[11]};
    } catch (const std::runtime_error& e) {
        failFile(file, e.what());
    }
    return pose;
}

Pose readCameraFromVelodyne(const fs::path& file) {
    std::istringstream lines(readBytes(file));
    for (std::string line; std::getline(lines, line);)
        for (const std::string key : {"Tr:", "Tr_velo_to_cam:"})
            if (line.rfind(key, 0) == 0)
                return parseTransform(file, line.substr(key.size()));
    failFile(file,
             "has no line 'Tr:' with the transform from velodyne to camera; take the "
             "calib.txt of the sequence");
}

/// The sequence's times, if it has any, into the poses.
void readTimes(const fs::path& file, PoseFile& poses) {
    if (!fs::exists(file)) return;
    std::vector<double> times;
    try {
        times = evaluation::parseNumbers(readBytes(file));
    } catch (const std::runtime_error& e) {
        failFile(file, e.what());
    }
    if (times.size() < poses.poses.size())
        failFile(file, "has only " + std::to_string(times.size()) + " times for " +
                           std::to_string(poses.poses.size()) +
                           " poses; remove or complete it");
    stampLines(times, poses);
}

RecordedCloud readVelodyne(const fs::path& file) {
    const std::string bytes = readBytes(file);
    constexpr std::size_t pointSize = 4 * sizeof(float);
    if (bytes.size() % pointSize != 0)
        failFile(file, "is truncated: its " + std::to_string(bytes.size()) +
                           " bytes are no multiple of the 16 of a point; fetch it again");
    RecordedCloud cloud;
    cloud.hasIntensity = true;
    cloud.used = {"x", "y", "z", "reflectance"};
    cloud.points.resize(bytes.size() / pointSize);
    for (std::size_t i = 0; i < cloud.points.size(); ++i) {
        float v[4];
        std::memcpy(v, bytes.data() + i * pointSize, pointSize);
        cloud.points[i].position = {v[0], v[1], v[2]};
        cloud.points[i].intensity = v[3];
    }
    return cloud;
}

}  // namespace

KittiSource::KittiSource(const std::string& folder, const std::string& poseFile,
                         const MatchOptions& match, const CloudOptions& options)
    : CloudSource(options) {
    const auto files = listFiles(fs::path(folder) / "velodyne", ".bin");
    const Pose T_camera_velodyne = readCameraFromVelodyne(fs::path(folder) / "calib.txt");
    auto poses = readPoseFile(poseFile);
    if (poses.key == PoseKey::none) readTimes(fs::path(folder) / "times.txt", poses);
    MatchOptions ofKitti = match;
    ofKitti.countsFromZero = true;
    const auto matching = matchPoses(files, poses, ofKitti);
    scans_ = matching.scans;
    for (auto& scan : scans_) scan.T_world_frame = scan.T_world_frame * T_camera_velodyne;
    summary_.notes = matching.notes;
    summary_.order = matching.order;
    summary_.withoutPose = matching.withoutPose;
    summary_.files = files;
    for (const char* name : {"calib.txt", "times.txt"})
        summary_.files.push_back(fs::path(folder) / name);
}

RecordedCloud KittiSource::readCloud(std::size_t index) const {
    return readVelodyne(scans_.at(index).path);
}

ImportedScan KittiSource::load(std::size_t index) const {
    ImportedScan scan = makeScan(readCloud(index), Pose{});
    scan.stamp = scans_[index].stamp;
    scan.T_world_robot = scans_[index].T_world_frame;
    return scan;
}

}  // namespace hgmm::importer
