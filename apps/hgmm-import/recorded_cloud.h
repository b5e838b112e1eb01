#pragma once
#include <Eigen/Core>
#include <array>
#include <optional>
#include <string>
#include <vector>

namespace hgmm::importer {

/// One point of a file, as the file has it: coordinates may be NaN.
struct RecordedPoint {
    Eigen::Vector3d position;         ///< in the file's own unit
    float intensity = 0;              ///< in the file's own unit
    std::array<float, 3> color = {};  ///< r, g, b in the file's own unit; NaN: not measured
};

/// What a cloud file holds.
struct RecordedCloud {
    std::vector<RecordedPoint> points;
    bool hasIntensity = false;
    bool hasColor = false;
    bool bytesOfIntensity = false;  ///< its field holds 8 bits, so that 255 is its most
    bool bytesOfColor = false;
    std::vector<std::string> used, unused;                  ///< names of fields
    std::vector<std::string> intensityFields, colorFields;  ///< of those used
    std::optional<Eigen::Vector3d> viewpoint;  ///< origin of the rays, if the file says it
};

}  // namespace hgmm::importer
