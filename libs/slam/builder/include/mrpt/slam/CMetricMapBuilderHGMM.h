#pragma once
#include <mrpt/maps/CHGMMOccupancyMap.h>
#include <mrpt/slam/CMetricMapBuilder.h>

#include <memory>
#include <string>
#include <utility>

namespace mrpt::slam {

/// Simultaneous localisation and mapping with Gaussian mixture maps (::hgmm::slam), for
/// programs that are written for MRPT's map builders.
///
/// In each frame, the first range observation counts, and of further frames those of the
/// sensor with its label. Actions with a movement are odometry; without, the robot is taken
/// to keep its velocity. With map updating disabled (CMetricMapBuilder::options), frames
/// move the pose and do not enter the map. Other options have no effect.
///
/// Not for concurrent use, but closures are looked for on a thread behind.
class CMetricMapBuilderHGMM : public CMetricMapBuilder {
 public:
    /// A pointer in MRPT 2.5, a reference in later releases.
    using BuiltMetricMap =
        decltype(std::declval<const CMetricMapBuilder&>().getCurrentlyBuiltMetricMap());

    /// Begins at the origin.
    /// Throws std::invalid_argument for options out of range.
    explicit CMetricMapBuilderHGMM(
        const mrpt::maps::CHGMMOccupancyMap::TInsertionOptions& insertion = {});
    ~CMetricMapBuilderHGMM() override;

    /// Begins anew.
    /// @param initialMap empty: building does not go on from a map
    /// @param x0 its mean is the pose of the first frame; the origin if null
    /// Throws std::invalid_argument for a map that is not empty.
    void initialize(const mrpt::maps::CSimpleMap& initialMap = {},
                    const mrpt::poses::CPosePDF* x0 = nullptr) override;

    /// A CPose3DPDFGaussian. Its covariance is that of the submap where the robot is, and 0
    /// in the first one.
    mrpt::poses::CPose3DPDF::Ptr getCurrentPoseEstimation() const override;
    /// Whether nothing of the last frame was recognised: its pose is a guess.
    bool isLost() const;

    /// Follows the robot to the next frame. Frames without a range observation add their
    /// movement to that of the next.
    void processActionObservation(mrpt::obs::CActionCollection& action,
                                  mrpt::obs::CSensoryFrame& observations) override;

    /// Frames at each .25 m or .25 rad of the way, with their poses as they are known now.
    void getCurrentlyBuiltMap(mrpt::maps::CSimpleMap& out_map) const override;
    unsigned int getCurrentlyBuiltMapSize() override;
    /// One CHGMMOccupancyMap, merged of the submaps when asked for. Holds until the next
    /// call of a function that is not const.
    BuiltMetricMap getCurrentlyBuiltMetricMap() const override;
    /// Writes the files of CHGMMOccupancyMap::saveMetricMapRepresentationToFile with this
    /// prefix.
    void saveCurrentEstimationToImage(const std::string& file,
                                      bool formatEMF_BMP = true) override;

 private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

}  // namespace mrpt::slam
