#pragma once
#include <mrpt/obs/CObservation3DRangeScan.h>

#include <vector>

#include "hgmm/scan.h"

namespace hgmm::mrpt_bridge {

/// The depth pixel that a point was seen in.
struct PixelOfPoint {
    int row, col;
};

/// Adds channels r, g, b, or intensity if the image is grey, in [0, 1], from the intensity
/// image of an observation, which must be loaded. Adds nothing if there is no visible 8-bit
/// image, or no telling where it looks.
///
/// If both cameras coincide and the images have the same size, a point has the colour of
/// its own pixel. Otherwise points are projected by relativePoseIntensityWRTDepth and
/// cameraParamsIntensity, for which the image must have the size that was calibrated.
/// Points outside the image or hidden from that camera by nearer points have the value NaN:
/// not measured.
///
/// @param pixels one for each point, or none at all if they are not known: points are
/// projected then
/// @param scan points in the frame of the depth camera, +X forward
void addImageColours(const mrpt::obs::CObservation3DRangeScan& observation,
                     const std::vector<PixelOfPoint>& pixels, Scan& scan);

}  // namespace hgmm::mrpt_bridge
