#include "sources/cloud_source.h"

#include <algorithm>
#include <cstdio>
#include <stdexcept>

namespace hgmm::importer {
namespace {

std::string number(double value) {
    char text[40];
    std::snprintf(text, sizeof text, "%g", value);
    return text;
}

/// Moves what MRPT's clouds have no room for from the used fields to the others.
void leaveOut(const std::vector<std::string>& names, ImportedScan& scan) {
    auto& used = scan.usedFields;
    for (const auto& name : names) {
        const auto field = std::find(used.begin(), used.end(), name);
        if (field == used.end()) continue;
        used.erase(field);
        scan.unusedFields.push_back(name);
    }
}

}  // namespace

CloudSource::CloudSource(const CloudOptions& options) : options_(options) {
    summary_.expectedRange = cloudRange(options.unitsPerMetre.has_value());
    if (options.unitsPerMetre)
        summary_.scale = number(*options.unitsPerMetre) + " units a metre";
}

void CloudSource::prepare() {
    LargestChannels largest;
    for (std::size_t i = 0; i < size(); ++i) {
        try {
            largest.add(readCloud(i));
        } catch (const std::runtime_error&) {
        }
    }
    scales_ = largest.scales();
    if (options_.intensityScale)
        scales_.intensity = static_cast<float>(*options_.intensityScale);
    if (!largest.hasIntensity()) return;
    if (!summary_.scale.empty()) summary_.scale += ", ";
    summary_.scale += "intensities divided by " + number(scales_.intensity) +
                      (options_.intensityScale ? "" : " (told by the largest)");
}

ImportedScan CloudSource::makeScan(RecordedCloud cloud, const Pose& T_frame_sensor) const {
    for (auto& point : cloud.points) point.position /= unitsPerMetre();
    ImportedScan scan;
    scan.usedFields = cloud.used;
    scan.unusedFields = cloud.unused;
    const auto made =
        makeCloudObservation(cloud, T_frame_sensor, scales_, options_.channel);
    scan.observation = made.observation;
    scan.droppedPoints = made.droppedPoints;
    if (cloud.hasColor && cloud.hasIntensity)
        leaveOut(options_.channel == CloudChannel::color ? cloud.intensityFields
                                                         : cloud.colorFields,
                 scan);
    return scan;
}

}  // namespace hgmm::importer
