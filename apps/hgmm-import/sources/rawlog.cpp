#include "sources/rawlog.h"

#include <hgmm/evaluation/recording.h>
#include <mrpt/obs/CObservation2DRangeScan.h>

#include "files.h"
#include "mrpt_pose.h"
#include "sources/embed.h"

namespace hgmm::importer {
namespace {

std::string orderOf(const evaluation::Recording& recording) {
    switch (recording.poseSource()) {
        case evaluation::PoseSource::file:
            return "by stamp";
        case evaluation::PoseSource::odometry:
            return "by the log's odometry";
        default:
            return "a single scan, at the origin";
    }
}

}  // namespace

RawlogSource::RawlogSource(const std::string& file, const std::string& posesFile,
                           std::optional<double> aperture_deg) {
    evaluation::RecordingOptions options;
    if (!posesFile.empty()) options.posesFile = posesFile;
    evaluation::Recording recording(file, options);
    if (!recording.damage().empty()) summary_.notes.push_back(recording.damage());
    std::size_t planar = 0;
    while (const auto recorded = recording.next()) {
        const auto laser = std::dynamic_pointer_cast<mrpt::obs::CObservation2DRangeScan>(
            recorded->observation);
        planar += laser ? 1 : 0;
        if (laser && aperture_deg)
            laser->aperture = static_cast<float>(mrpt::DEG2RAD(*aperture_deg));
        ImportedScan imported;
        imported.observation = recorded->observation;
        imported.stamp = recorded->time_s;
        imported.T_world_robot = fromMrpt(recorded->T_map_robot);
        scans_.push_back(std::move(imported));
    }
    if (aperture_deg && planar == 0)
        failFile(file, "holds no 2D range scan, which --aperture is for");
    summary_.order = orderOf(recording);
    if (planar > 0 && planar < scans_.size())
        summary_.notes.push_back(std::to_string(planar) + " planar scans and " +
                                 std::to_string(scans_.size() - planar) + " others");
}

ImportedScan RawlogSource::load(std::size_t index) const {
    ImportedScan scan = scans_.at(index);
    try {
        // A copy: what is loaded goes when it is written.
        scan.observation = std::dynamic_pointer_cast<mrpt::obs::CObservation>(
            scan.observation->duplicateGetSmartPtr());
        embed(*scan.observation);
    } catch (const std::exception& e) {
        throw std::runtime_error("scan " + std::to_string(index) +
                                 " keeps data in files beside the log, which cannot be "
                                 "read: " +
                                 std::string(e.what()).substr(0, 200));
    }
    return scan;
}

}  // namespace hgmm::importer
