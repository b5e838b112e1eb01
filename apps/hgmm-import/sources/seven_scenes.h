#pragma once
#include "rgbd_observation.h"
#include "sources/source.h"

namespace hgmm::importer {

/// A folder of Microsoft's 7-Scenes: frame-N.depth.png (16 bit, mm unless the options
/// say otherwise, 0 and 65535 invalid),
/// frame-N.pose.txt (4x4, T_world_camera of the optical frame), optionally
/// frame-N.color.jpg or .png and camera-intrinsics.txt (3x3). The dataset has no times:
/// frame N is stamped N / 30 s, the rate of the Kinect. Frames without a pose, or with one
/// that is no pose, are left out and counted.
class SevenScenesSource : public Source {
 public:
    /// Intrinsics given here go before the file, and the file before the dataset's usual
    /// fx = fy = 585, cx = 320, cy = 240.
    SevenScenesSource(const std::string& folder, const RgbdOptions& options);

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
