#include "sources/kitti.h"

#include <hgmm/evaluation/parse_numbers.h>

#include <algorithm>
#include <cstring>
#include <sstream>

#include "cloud_observation.h"

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
void readTimes(const fs::path& file, evaluation::Trajectory& poses) {
    if (!fs::exists(file)) return;
    std::vector<double> times;
    try {
        times = evaluation::parseNumbers(readBytes(file));
    } catch (const std::runtime_error& e) {
        failFile(file, e.what());
    }
    if (times.size() < poses.size())
        failFile(file, "has only " + std::to_string(times.size()) + " times for " +
                           std::to_string(poses.size()) + " poses; remove or complete it");
    for (std::size_t i = 0; i < poses.size(); ++i) poses[i].stamp = times[i];
}

PcdCloud readVelodyne(const fs::path& file) {
    const std::string bytes = readBytes(file);
    constexpr std::size_t pointSize = 4 * sizeof(float);
    if (bytes.size() % pointSize != 0)
        failFile(file, "is truncated: its " + std::to_string(bytes.size()) +
                           " bytes are no multiple of the 16 of a point; fetch it again");
    PcdCloud cloud;
    cloud.hasIntensity = true;
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

KittiSource::KittiSource(const std::string& folder, const std::string& poseFile) {
    const auto files = listNumberedFiles(fs::path(folder) / "velodyne", ".bin");
    const Pose T_camera_velodyne = readCameraFromVelodyne(fs::path(folder) / "calib.txt");
    auto poses = evaluation::readTrajectory(poseFile);
    readTimes(fs::path(folder) / "times.txt", poses);
    const bool inOrder = poses.size() == files.size();
    for (std::size_t i = 0; i < files.size(); ++i) {
        const auto& [path, number] = files[i];
        const std::size_t line = inOrder ? i : static_cast<std::size_t>(number);
        if (line >= poses.size())
            failFile(poseFile,
                     "has only " + std::to_string(poses.size()) + " poses, " +
                         std::to_string(files.size()) + " scans want one up to number " +
                         std::to_string(files.back().number) +
                         " (counted from 0); give the poses of the whole sequence");
        const auto& pose = poses[line];
        scans_.push_back({path, pose.stamp, pose.T_world_frame * T_camera_velodyne});
    }
    if (!inOrder)
        notes_.push_back(poseFile + ": has " + std::to_string(poses.size()) +
                         " poses for " + std::to_string(files.size()) +
                         " scans; each scan takes the pose of its number");
}

ImportedScan KittiSource::load(std::size_t index) const {
    const auto& scan = scans_.at(index);
    auto [observation, dropped] = makeCloudObservation(readVelodyne(scan.path), Pose{});
    return {observation, scan.stamp, scan.T_world_velodyne, dropped};
}

}  // namespace hgmm::importer
