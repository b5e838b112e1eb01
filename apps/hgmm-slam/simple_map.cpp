#include "simple_map.h"

#include <hgmm/mrpt_bridge/observation_to_scan.h>
#include <hgmm/slam/uncertain_pose.h>
#include <mrpt/maps/CSimpleMap.h>
#include <mrpt/obs/CSensoryFrame.h>
#include <mrpt/poses/CPose3DPDFGaussian.h>
#include <mrpt/serialization/CArchive.h>

#include <stdexcept>
#include <utility>

namespace hgmm::slam_app {
namespace {

constexpr double kKeyframe_m = 0.25;
constexpr double kKeyframe_rad = 0.25;

}  // namespace

SimpleMapOfRecording::SimpleMapOfRecording(std::string log,
                                           const evaluation::RecordingOptions& options,
                                           const evaluation::Trajectory& trajectory)
    : log_(std::move(log)), options_(options), trajectory_(trajectory) {
    for (std::size_t i = 0; i < trajectory.size(); ++i) {
        if (!keyframes_.empty()) {
            const slam::Vector6d moved = slam::errorOf(
                trajectory[i].T_world_frame, trajectory[keyframes_.back()].T_world_frame);
            if (moved.tail<3>().norm() < kKeyframe_m &&
                moved.head<3>().norm() < kKeyframe_rad)
                continue;
        }
        keyframes_.push_back(i);
    }
}

const mrpt::rtti::TRuntimeClassId* SimpleMapOfRecording::GetRuntimeClass() const {
    return CLASS_ID(mrpt::maps::CSimpleMap);
}

void SimpleMapOfRecording::serializeTo(mrpt::serialization::CArchive& out) const {
    out.WriteAs<std::uint32_t>(keyframes_.size());
    evaluation::Recording recording(log_, options_);
    std::size_t next = 0;
    for (std::size_t i = 0; next < keyframes_.size(); ++i) {
        const auto recorded = recording.next();
        if (!recorded) throw std::runtime_error(log_ + ": has become shorter meanwhile");
        if (i != keyframes_[next]) continue;
        ++next;
        mrpt::poses::CPose3DPDFGaussian pose(
            mrpt_bridge::toCPose3D(trajectory_[i].T_world_frame));
        mrpt::obs::CSensoryFrame frame;
        frame.insert(recorded->observation);
        out << pose << frame;
    }
}

void SimpleMapOfRecording::serializeFrom(mrpt::serialization::CArchive&, uint8_t) {
    throw std::logic_error("SimpleMapOfRecording: is written only");
}

}  // namespace hgmm::slam_app
