#include "sources/cloud_files.h"

#include <hgmm/evaluation/trajectory.h>

#include "files.h"
#include "pcd_reader.h"
#include "ply_reader.h"

namespace hgmm::importer {

CloudFilesSource::CloudFilesSource(const std::string& folder, const std::string& suffix,
                                   const std::string& poseFile, const MatchOptions& match,
                                   const Pose& T_frame_sensor, const CloudOptions& options)
    : CloudSource(options), T_frame_sensor_(T_frame_sensor) {
    const auto files = listFiles(folder, suffix);
    const auto matching = matchPoses(files, readPoseFile(poseFile), match);
    scans_ = matching.scans;
    summary_.notes = matching.notes;
    summary_.order = matching.order;
    summary_.withoutPose = matching.withoutPose;
    summary_.files = files;
}

RecordedCloud CloudFilesSource::readCloud(std::size_t index) const {
    const auto& path = scans_.at(index).path;
    return path.extension() == ".ply" ? readPly(path.string()) : readPcd(path.string());
}

ImportedScan CloudFilesSource::load(std::size_t index) const {
    ImportedScan scan = makeScan(readCloud(index), T_frame_sensor_);
    scan.stamp = scans_[index].stamp;
    scan.T_world_robot = scans_[index].T_world_frame;
    return scan;
}

WorldFramePcdSource::WorldFramePcdSource(const std::string& folder,
                                         const CloudOptions& options)
    : CloudSource(options), files_(orderByName(listFiles(folder, ".pcd"))) {
    summary_.order = "by name, poses from VIEWPOINT";
    summary_.files = files_;
}

RecordedCloud WorldFramePcdSource::readCloud(std::size_t index) const {
    return readPcd(files_.at(index).string());
}

ImportedScan WorldFramePcdSource::load(std::size_t index) const {
    const auto cloud = readCloud(index);
    if (!cloud.viewpoint)
        failFile(files_[index],
                 "has no VIEWPOINT line, which --world-frame takes as the ray origin; add "
                 "it, or give --poses");
    Pose T_world_sensor;
    T_world_sensor.t = *cloud.viewpoint / unitsPerMetre();
    ImportedScan scan = makeScan(cloud, T_world_sensor);
    // The pose file carries the origin, as it does for all recordings.
    scan.observation->setSensorPose(mrpt::poses::CPose3D());
    scan.stamp = static_cast<double>(index) * evaluation::kDefaultPosePeriod;
    scan.T_world_robot = T_world_sensor;
    return scan;
}

}  // namespace hgmm::importer
