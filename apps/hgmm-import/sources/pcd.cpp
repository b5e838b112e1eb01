#include "sources/pcd.h"

#include "cloud_observation.h"

namespace hgmm::importer {

PcdSource::PcdSource(const std::string& folder, const std::string& poseFile,
                     const Pose& T_frame_sensor)
    : files_(listNumberedFiles(folder, ".pcd")),
      poses_(evaluation::readTrajectory(poseFile)),
      T_frame_sensor_(T_frame_sensor) {
    const std::string counts = std::to_string(poses_.size()) + " poses for the " +
                               std::to_string(files_.size()) + " .pcd files of " + folder;
    if (poses_.size() < files_.size())
        failFile(poseFile, "has only " + counts + "; give a file with one pose for each");
    if (poses_.size() > files_.size())
        notes_.push_back(poseFile + ": has " + counts + "; the last ones are not used");
}

ImportedScan PcdSource::load(std::size_t index) const {
    const auto cloud = readPcd(files_.at(index).path.string());
    auto [observation, dropped] = makeCloudObservation(cloud, T_frame_sensor_);
    return {observation, poses_[index].stamp, poses_[index].T_world_frame, dropped};
}

WorldFramePcdSource::WorldFramePcdSource(const std::string& folder)
    : files_(listNumberedFiles(folder, ".pcd")) {}

ImportedScan WorldFramePcdSource::load(std::size_t index) const {
    const auto& path = files_.at(index).path;
    const auto cloud = readPcd(path.string());
    if (!cloud.viewpoint)
        failFile(path,
                 "has no VIEWPOINT line, which --world-frame takes as the ray origin; add "
                 "it, or give --poses");
    Pose T_world_sensor;
    T_world_sensor.t = *cloud.viewpoint;
    auto [observation, dropped] = makeCloudObservation(cloud, T_world_sensor);
    // The pose file carries the origin, as it does for all recordings.
    observation->sensorPose = mrpt::poses::CPose3D();
    const double stamp = static_cast<double>(index) * evaluation::kDefaultPosePeriod;
    return {observation, stamp, T_world_sensor, dropped};
}

}  // namespace hgmm::importer
