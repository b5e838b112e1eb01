#pragma once
#include <hgmm/evaluation/trajectory.h>

#include <optional>

#include "files.h"
#include "sources/source.h"

namespace hgmm::importer {

/// A sequence of the KITTI odometry benchmark: velodyne/N.bin (x y z reflectance, float32),
/// calib.txt with the line "Tr:" (camera from velodyne), optionally times.txt, and a pose
/// file of the left camera. The world frame is that of the pose file (the first camera: z
/// forward, y down); poses written are T_world_velodyne. Pose N (from 0) belongs to N.bin,
/// so that the folder may hold a part of the sequence; if there are as many poses as files,
/// pose i belongs to file i.
class KittiSource : public Source {
 public:
    /// Throws std::runtime_error if a file's pose or time is missing.
    KittiSource(const std::string& folder, const std::string& poseFile);

    std::size_t size() const override { return scans_.size(); }
    ImportedScan load(std::size_t index) const override;

 private:
    struct ScanFile {
        std::filesystem::path path;
        double stamp = 0;
        Pose T_world_velodyne;
    };
    std::vector<ScanFile> scans_;
};

}  // namespace hgmm::importer
