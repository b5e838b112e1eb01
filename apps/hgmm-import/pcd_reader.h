#pragma once
#include <Eigen/Core>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace hgmm::importer {

/// One point of a PCD file, as the file has it: coordinates may be NaN.
struct PcdPoint {
    Eigen::Vector3d position;  ///< [m]
    float intensity = 0;       ///< in the file's own unit
    std::uint8_t r = 0, g = 0, b = 0;
};

/// What a PCD file holds.
struct PcdCloud {
    std::vector<PcdPoint> points;
    bool hasIntensity = false;
    bool hasColor = false;
    std::optional<Eigen::Vector3d>
        viewpoint;  ///< first three numbers of VIEWPOINT [m], if any
};

/// Reads a file of the Point Cloud Library, version 0.7, with DATA ascii, binary or
/// binary_compressed. Fields may be of any order, size and type; x, y, z are needed,
/// intensity and rgb (or rgba) are read, others skipped. Zero bytes and blanks after the
/// last point are accepted. Throws std::runtime_error that names the file if it is no such
/// file, is shorter than its header says, or has other bytes after the last point.
PcdCloud readPcd(const std::string& file);

}  // namespace hgmm::importer
