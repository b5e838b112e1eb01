#include "recording_writer.h"

#include <mrpt/core/Clock.h>
#include <mrpt/obs/CActionCollection.h>
#include <mrpt/obs/CObservation2DRangeScan.h>
#include <mrpt/obs/CObservationPointCloud.h>
#include <mrpt/obs/CSensoryFrame.h>
#include <mrpt/poses/CPose3DPDFGaussian.h>

#include <cmath>

#include "hgmm/mrpt_bridge/observation_to_scan.h"
#include "mrpt_pose.h"

namespace hgmm::importer {

using mrpt_bridge::FileKind;
using mrpt_bridge::Output;
using mrpt_bridge::OutputFile;

namespace {

constexpr double kLatestStamp = 1e10;

mrpt::maps::CSimpleMap ofOneCloud(const mrpt::maps::CSimplePointsMap::Ptr& cloud) {
    cloud->mark_as_modified();
    auto observation = mrpt::obs::CObservationPointCloud::Create();
    observation->pointcloud = cloud;
    auto frame = mrpt::obs::CSensoryFrame::Create();
    frame->insert(observation);
    mrpt::maps::CSimpleMap map;
    map.insert(mrpt::poses::CPose3DPDFGaussian::Create(), frame);
    return map;
}

}  // namespace

std::vector<Output> RecordingOutputs::files() const {
    return {{rawlog, FileKind::rawlog},
            {poses, FileKind::numbers},
            {simplemap, FileKind::simpleMap},
            {cloud, FileKind::simpleMap}};
}

RecordingWriter::RecordingWriter(const RecordingOutputs& outputs)
    : outputs_(outputs),
      rawlogFile_(outputs.files()[0], outputs.replace),
      posesFile_(outputs.files()[1], outputs.replace),
      rawlog_(rawlogFile_),
      generator_(outputs.seed) {
    if (!outputs.simplemap.empty())
        simplemapFile_.emplace(outputs.files()[2], outputs.replace);
    if (!outputs.cloud.empty()) cloudFile_.emplace(outputs.files()[3], outputs.replace);
}

void RecordingWriter::add(const ImportedScan& scan) {
    if (!(std::abs(scan.stamp) < kLatestStamp))
        throw std::runtime_error("the time stamp " + std::to_string(scan.stamp) +
                                 " is out of range; give stamps in seconds");
    // Whole microseconds, so that the observation and the pose file say the same.
    const double stamp = std::round(scan.stamp * 1e6) / 1e6;
    scan.observation->timestamp = mrpt::Clock::fromDouble(stamp);
    auto frame = mrpt::obs::CSensoryFrame::Create();
    frame->insert(scan.observation);
    if (outputs_.actions)
        writeActionPair(scan, frame);
    else
        rawlog_.write(*scan.observation);
    trajectory_.push_back({stamp, scan.T_world_robot});
    if (!outputs_.cloud.empty()) addToCloud(scan);
    if (outputs_.simplemap.empty()) return;
    simplemap_.insert(mrpt::poses::CPose3DPDFGaussian::Create(toMrpt(scan.T_world_robot)),
                      frame);
}

void RecordingWriter::addToCloud(const ImportedScan& scan) {
    const auto points =
        mrpt_bridge::observationToScan(*scan.observation, toMrpt(scan.T_world_robot));
    if (!points) return;
    const Pose& T = points->T_map_sensor;
    for (std::size_t i = 0; i < points->size(); ++i) {
        const Eigen::Vector3f p =
            (T.R * Eigen::Vector3d(points->x[i], points->y[i], points->z[i]) + T.t)
                .cast<float>();
        cloud_->insertPointFast(p.x(), p.y(), p.z());
    }
}

void RecordingWriter::writeActionPair(const ImportedScan& scan,
                                      const mrpt::obs::CSensoryFrame::Ptr& frame) {
    // The first pair stands still, where the first pose is.
    const Pose increment =
        trajectory_.empty()
            ? Pose{}
            : trajectory_.back().T_world_frame.inverse() * scan.T_world_robot;
    const OdometryNoise noise = trajectory_.empty() ? OdometryNoise{} : outputs_.noise;
    const Pose measured = withNoise(increment, noise, generator_);
    mrpt::obs::CAction::Ptr action;
    if (IS_CLASS(*scan.observation, mrpt::obs::CObservation2DRangeScan))
        action = makePlanarMotionAction(measured, noise, outputs_.turnErrorPerMetre_deg);
    else
        action = makeMotionAction(measured, noise);
    action->timestamp = scan.observation->timestamp;
    mrpt::obs::CActionCollection actions;
    actions.insert(*action);
    rawlog_.write(actions);
    rawlog_.write(*frame);
}

void RecordingWriter::commit() {
    std::vector<OutputFile*> files{&posesFile_};
    const std::string poses = evaluation::tumText(trajectory_);
    posesFile_.write(poses.data(), poses.size());
    if (simplemapFile_) {
        mrpt_bridge::writeObject(*simplemapFile_, simplemap_);
        files.push_back(&*simplemapFile_);
    }
    if (cloudFile_) {
        mrpt_bridge::writeObject(*cloudFile_, ofOneCloud(cloud_));
        files.push_back(&*cloudFile_);
    }
    rawlog_.close();
    files.push_back(&rawlogFile_);
    OutputFile::commitAll(files);
}

}  // namespace hgmm::importer
