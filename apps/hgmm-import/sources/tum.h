#pragma once
#include "rgbd_observation.h"
#include "sources/source.h"

namespace hgmm::importer {

/// A sequence of the TUM RGB-D benchmark: depth.txt and rgb.txt (lines `time file`), depth
/// PNGs with 5000 units a metre unless the options say otherwise, registered to the colour
/// images, and groundtruth.txt (TUM lines, T_world_camera of the optical frame). Each depth
/// image gets the pose at its time (interpolated; left out with a note if the nearest is
/// farther than the tolerance) and the colour image nearest in time, if one is within it
/// and rgb.txt is there. Lens distortion is not modelled.
class TumSource : public Source {
 public:
    /// Without intrinsics the camera is told by "fr1", "fr2", "fr3" or "freiburg1" etc. in
    /// the folder's name; throws std::runtime_error if it is none of them.
    TumSource(const std::string& folder, const RgbdOptions& options);

    std::size_t size() const override { return frames_.size(); }
    ImportedScan load(std::size_t index) const override;

 private:
    struct Frame {
        RgbdFiles images;
        double stamp = 0;
        Pose T_world_optical;
    };
    std::vector<Frame> frames_;
    Intrinsics camera_;
    DepthFormat format_;
};

}  // namespace hgmm::importer
