#pragma once
#include <filesystem>
#include <vector>

#include "match_poses.h"
#include "sources/cloud_source.h"

namespace hgmm::importer {

/// A folder of cloud files, .pcd or .ply, with a pose for each: that of the frame that the
/// points are given in (matchPoses).
class CloudFilesSource : public CloudSource {
 public:
    /// @param suffix of the files: ".pcd" or ".ply"
    /// @param T_frame_sensor where the sensor, the ray origin, sits in that frame
    CloudFilesSource(const std::string& folder, const std::string& suffix,
                     const std::string& poseFile, const MatchOptions& match,
                     const Pose& T_frame_sensor, const CloudOptions& options);

    std::size_t size() const override { return scans_.size(); }
    ImportedScan load(std::size_t index) const override;

 protected:
    RecordedCloud readCloud(std::size_t index) const override;

 private:
    std::vector<PosedFile> scans_;
    Pose T_frame_sensor_;
};

/// A folder of PCD files in the order of their names whose points are in the world frame
/// already. The ray origin is in VIEWPOINT; the sensor's rotation is unknown and taken as
/// the identity. Scans are stamped kDefaultPosePeriod apart, from 0 on.
class WorldFramePcdSource : public CloudSource {
 public:
    WorldFramePcdSource(const std::string& folder, const CloudOptions& options);

    std::size_t size() const override { return files_.size(); }
    ImportedScan load(std::size_t index) const override;

 protected:
    RecordedCloud readCloud(std::size_t index) const override;

 private:
    std::vector<std::filesystem::path> files_;
};

}  // namespace hgmm::importer
