#pragma once
#include <vector>

#include "match_poses.h"
#include "sources/cloud_source.h"

namespace hgmm::importer {

/// A sequence of the KITTI odometry benchmark: velodyne/N.bin (x y z reflectance, float32),
/// calib.txt with the line "Tr:" (camera from velodyne), optionally times.txt, and a pose
/// file of the left camera. The world frame is that of the pose file (the first camera: z
/// forward, y down); poses written are T_world_velodyne. Pose N (from 0) belongs to N.bin,
/// so that the folder may hold a part of the sequence; if N.bin are numbered without gaps
/// and there are as many poses, the first pose belongs to the first of them.
class KittiSource : public CloudSource {
 public:
    KittiSource(const std::string& folder, const std::string& poseFile,
                const MatchOptions& match, const CloudOptions& options);

    std::size_t size() const override { return scans_.size(); }
    ImportedScan load(std::size_t index) const override;

 protected:
    RecordedCloud readCloud(std::size_t index) const override;

 private:
    std::vector<PosedFile> scans_;
};

}  // namespace hgmm::importer
