#pragma once
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "hgmm/mixture.h"

namespace hgmm::evaluation {

/// How to look at a mixture: an orthographic view from outside.
struct View {
    double yaw_deg = 30.0;    ///< of the viewing direction about z [deg]
    double pitch_deg = 30.0;  ///< of the viewing direction below the horizon [deg]
    double sigmas = 2.0;      ///< size of the ellipsoids [sigma], > 0
    double cut = 0.0;     ///< share of the depth, from the viewer on, left out, in [0, 1)
    int width_px = 1280;  ///< [px], the height follows
};

/// 8-bit RGB, row by row from the top.
struct Picture {
    int width_px = 0, height_px = 0;
    std::vector<std::uint8_t> rgb;
};

/// Draws each component as a shaded ellipsoid coloured by height, without a display: the
/// depth of an ellipsoid along a pixel's ray is the mean and spread of the Gaussian's depth
/// given the pixel. Throws std::invalid_argument for an empty mixture or a view outside its
/// ranges.
Picture renderEllipsoids(const Mixture<3>& mixture, const View& view);

/// Throws std::runtime_error naming the file if it cannot be written.
void writePng(const Picture& picture, const std::string& file);

}  // namespace hgmm::evaluation
