#include "recording_writer.h"

#include <mrpt/core/Clock.h>
#include <mrpt/obs/CActionCollection.h>
#include <mrpt/obs/CObservation2DRangeScan.h>
#include <mrpt/obs/CObservationPointCloud.h>
#include <mrpt/obs/CSensoryFrame.h>
#include <mrpt/poses/CPose3DPDFGaussian.h>
#include <mrpt/serialization/CArchive.h>

#include <cmath>
#include <fstream>

#include "files.h"
#include "hgmm/mrpt_bridge/observation_to_scan.h"
#include "mrpt_pose.h"

namespace hgmm::importer {
namespace {

constexpr double kLatestStamp = 1e10;

/// gzip ends with the uncompressed length modulo 2^32, which shows whether all of it got
/// there: closing the stream reports no errors.
bool gzipHolds(const std::string& file, std::uint64_t length) {
    std::ifstream in(file, std::ios::binary);
    in.seekg(-4, std::ios::end);
    unsigned char tail[4] = {};
    in.read(reinterpret_cast<char*>(tail), sizeof tail);
    std::uint32_t stored = 0;
    for (int i = 0; i < 4; ++i) stored |= std::uint32_t{tail[i]} << (8 * i);
    return in && stored == static_cast<std::uint32_t>(length);
}

void save(const mrpt::maps::CSimpleMap& map, const std::string& name) {
    OutputFile file(name);
    if (!map.saveToFile(file.temporaryPath()))
        failFile(name, "cannot be written; check folder and room on the disk");
    file.commit();
}

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

RecordingWriter::RecordingWriter(const RecordingOutputs& outputs)
    : outputs_(outputs), rawlogFile_(outputs.rawlog), generator_(outputs.seed) {
    if (!rawlog_.open(rawlogFile_.temporaryPath()))
        failFile(outputs.rawlog,
                 "cannot be written; check that its folder exists and is writable");
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
    try {
        if (outputs_.actions)
            writeActionPair(scan, frame);
        else
            mrpt::serialization::archiveFrom(rawlog_) << *scan.observation;
    } catch (const std::exception&) {
        failFile(outputs_.rawlog, "cannot be written; check that the disk has room");
    }
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
    auto archive = mrpt::serialization::archiveFrom(rawlog_);
    archive << actions << *frame;
}

void RecordingWriter::commit() {
    const std::uint64_t length = rawlog_.getPosition();
    rawlog_.close();
    if (!gzipHolds(rawlogFile_.temporaryPath(), length))
        failFile(outputs_.rawlog,
                 "could not be written whole; check that the disk has room");
    if (!outputs_.simplemap.empty()) save(simplemap_, outputs_.simplemap);
    if (!outputs_.cloud.empty()) save(ofOneCloud(cloud_), outputs_.cloud);
    evaluation::writeTumTrajectory(outputs_.poses, trajectory_);
    rawlogFile_.commit();
}

}  // namespace hgmm::importer
