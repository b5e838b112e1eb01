#include "sources/simplemap.h"

#include <hgmm/evaluation/trajectory.h>
#include <hgmm/mrpt_bridge/observation_to_scan.h>
#include <mrpt/core/Clock.h>
#include <mrpt/maps/CSimpleMap.h>
#include <mrpt/obs/CSensoryFrame.h>

#include <algorithm>
#include <filesystem>

#include "files.h"
#include "mrpt_pose.h"

namespace hgmm::importer {
namespace {

bool read(mrpt::maps::CSimpleMap& map, const std::string& file) {
    try {
        return map.loadFromFile(file);
    } catch (const std::exception&) {
        return false;
    }
}

}  // namespace

SimpleMapSource::SimpleMapSource(const std::string& file) {
    if (!std::filesystem::exists(file)) failFile(file, "does not exist");
    mrpt::maps::CSimpleMap map;
    if (!read(map, file)) failFile(file, "is not a simple map of MRPT, or is damaged");
    for (const auto& keyframe : map) {
        for (const auto& observation : *keyframe.sf) {
            if (!mrpt_bridge::isSupported(*observation)) continue;
            ImportedScan scan;
            scan.observation = observation;
            scan.T_world_robot = fromMrpt(keyframe.pose->getMeanVal());
            scans_.push_back(std::move(scan));
        }
    }
    if (scans_.empty()) failFile(file, "holds no scan; it needs range observations");
    summary_.order = "by keyframe";
    readStamps();
}

void SimpleMapSource::readStamps() {
    const bool valid = std::all_of(scans_.begin(), scans_.end(), [](const auto& scan) {
        return scan.observation->timestamp != INVALID_TIMESTAMP;
    });
    for (std::size_t i = 0; i < scans_.size(); ++i)
        scans_[i].stamp = valid ? mrpt::Clock::toDouble(scans_[i].observation->timestamp)
                                : evaluation::kDefaultPosePeriod * static_cast<double>(i);
    const bool rising =
        std::is_sorted(scans_.begin(), scans_.end(),
                       [](const auto& a, const auto& b) { return a.stamp < b.stamp; });
    if (rising) return;
    summary_.notes.push_back("time stamps go back; scans are stamped 0.1 s apart instead");
    for (std::size_t i = 0; i < scans_.size(); ++i)
        scans_[i].stamp = evaluation::kDefaultPosePeriod * static_cast<double>(i);
}

}  // namespace hgmm::importer
