#pragma once
#include <hgmm/evaluation/recording.h>
#include <hgmm/evaluation/trajectory.h>
#include <mrpt/serialization/CSerializable.h>

#include <cstddef>
#include <string>
#include <vector>

namespace hgmm::slam_app {

/// Keyframes, poses with the observations made there, as MRPT's CSimpleMap is stored. The
/// observations come from the recording while it is written, and are never held.
class SimpleMapOfRecording : public mrpt::serialization::CSerializable {
 public:
    /// @param trajectory of the first scans of the recording; one is a keyframe where the
    /// robot has moved since the last one
    SimpleMapOfRecording(std::string log, const evaluation::RecordingOptions& options,
                         const evaluation::Trajectory& trajectory);

    /// That of mrpt::maps::CSimpleMap.
    const mrpt::rtti::TRuntimeClassId* GetRuntimeClass() const override;
    mrpt::rtti::CObject* clone() const override { return new SimpleMapOfRecording(*this); }

 private:
    uint8_t serializeGetVersion() const override { return 1; }
    void serializeTo(mrpt::serialization::CArchive& out) const override;
    void serializeFrom(mrpt::serialization::CArchive& in, uint8_t version) override;

    std::string log_;
    evaluation::RecordingOptions options_;
    const evaluation::Trajectory& trajectory_;
    std::vector<std::size_t> keyframes_;  // indices into the trajectory, rising
};

}  // namespace hgmm::slam_app
