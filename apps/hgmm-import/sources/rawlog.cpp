#include "sources/rawlog.h"

#include <hgmm/evaluation/recording.h>
#include <mrpt/obs/CObservation2DRangeScan.h>

#include "files.h"
#include "mrpt_pose.h"

namespace hgmm::importer {

RawlogSource::RawlogSource(const std::string& file, const std::string& posesFile,
                           std::optional<double> aperture_deg) {
    evaluation::RecordingOptions options;
    if (!posesFile.empty()) options.posesFile = posesFile;
    evaluation::Recording recording(file, options);
    if (!recording.damage().empty()) summary_.notes.push_back(recording.damage());
    std::size_t others = 0;
    while (const auto recorded = recording.next()) {
        const auto scan = std::dynamic_pointer_cast<mrpt::obs::CObservation2DRangeScan>(
            recorded->observation);
        if (!scan) {
            ++others;
            continue;
        }
        if (aperture_deg) scan->aperture = static_cast<float>(mrpt::DEG2RAD(*aperture_deg));
        ImportedScan imported;
        imported.observation = scan;
        imported.stamp = recorded->time_s;
        imported.T_world_robot = fromMrpt(recorded->T_map_robot);
        scans_.push_back(std::move(imported));
    }
    if (scans_.empty()) failFile(file, "holds no 2D range scan");
    summary_.order = posesFile.empty() ? "by the log's odometry" : "by stamp";
    if (others > 0)
        summary_.notes.push_back(std::to_string(others) +
                                 " scans that are not 2D are left out");
}

}  // namespace hgmm::importer
