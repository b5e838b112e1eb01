#pragma once
#include <hgmm/evaluation/trajectory.h>

#include <optional>

#include "files.h"
#include "sources/source.h"

namespace hgmm::importer {

/// A folder of PCD files in numeric order, pose i for file i: the pose of the frame that
/// the points are given in. Further poses are left out with a note.
class PcdSource : public Source {
 public:
    /// T_frame_sensor: where the sensor, the ray origin, sits in that frame. Throws
    /// std::runtime_error if there are fewer poses than files.
    PcdSource(const std::string& folder, const std::string& poseFile,
              const Pose& T_frame_sensor);

    std::size_t size() const override { return files_.size(); }
    ImportedScan load(std::size_t index) const override;

 private:
    std::vector<NumberedFile> files_;
    evaluation::Trajectory poses_;
    Pose T_frame_sensor_;
};

/// A folder of PCD files in numeric order whose points are in the world frame already. The
/// ray origin is in VIEWPOINT; the sensor's rotation is unknown and taken as the identity.
/// Scans are stamped kDefaultPosePeriod apart, from 0 on.
class WorldFramePcdSource : public Source {
 public:
    explicit WorldFramePcdSource(const std::string& folder);

    std::size_t size() const override { return files_.size(); }
    ImportedScan load(std::size_t index) const override;

 private:
    std::vector<NumberedFile> files_;
};

}  // namespace hgmm::importer
