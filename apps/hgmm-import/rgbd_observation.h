#pragma once
#include <hgmm/scan.h>
#include <mrpt/obs/CObservation3DRangeScan.h>

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>

namespace hgmm::importer {

/// Pinhole camera without distortion [pixels].
struct Intrinsics {
    double fx = 0, fy = 0, cx = 0, cy = 0;
};

/// The files of one RGB-D frame.
struct RgbdFiles {
    std::filesystem::path depth;                 ///< PNG, one channel of 16 bits
    std::optional<std::filesystem::path> color;  ///< 8 bits, pixel-aligned with the depth
};

/// How depth pixels are to be read.
struct DepthFormat {
    float metresPerUnit = 0.001F;              ///< [m] of one unit of the PNG
    std::optional<std::uint16_t> alsoInvalid;  ///< marks "no depth" besides 0
};

/// What the user says of a depth camera.
struct RgbdOptions {
    std::optional<Intrinsics> intrinsics;
    std::optional<double> unitsPerMetre;  ///< of the depth images
    double tolerance_s = 0.02;  ///< most between an image and a pose or colour image [s]
};

/// For the closing line: how many units of a depth image are a metre.
std::string describeScale(const RgbdOptions& options, double usualUnitsPerMetre);

/// The rotation from MRPT's camera axes (x forward, y left, z up) to those of pose files (x
/// right, y down, z forward): the sensorPose of a camera whose pose is that of its optical
/// frame.
Pose opticalFromMrptCamera();

/// A frame as MRPT's depth observation: depth within the rawlog, colour (if any) as an
/// image that MRPT compresses as JPEG, sensorPose as above. Throws std::runtime_error that
/// names the file if an image cannot be decoded, is of another kind, or the two differ in
/// size.
mrpt::obs::CObservation3DRangeScan::Ptr makeRgbdObservation(const RgbdFiles& files,
                                                            const Intrinsics& camera,
                                                            const DepthFormat& format);

}  // namespace hgmm::importer
