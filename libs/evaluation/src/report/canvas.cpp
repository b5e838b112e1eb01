#include "report/canvas.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "hgmm/params.h"

namespace hgmm::evaluation {
namespace {

constexpr int kMaxHeight_px = 2000;
constexpr double kMargin = 0.03;  // of the picture's width
constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// Pixels may lie anywhere; only those of the picture fit an int.
int clampedPixel(double at, int low, int high) {
    return static_cast<int>(std::clamp(std::floor(at), double(low), double(high)));
}

}  // namespace

Rgb scaleColour(double share) {
    static constexpr std::array<Rgb, 5> stops = {{{0.27, 0.00, 0.33},
                                                  {0.23, 0.32, 0.55},
                                                  {0.13, 0.57, 0.55},
                                                  {0.37, 0.79, 0.38},
                                                  {0.99, 0.91, 0.14}}};
    const double at = std::clamp(share, 0.0, 1.0) * (stops.size() - 1);
    const auto below =
        std::min<std::size_t>(static_cast<std::size_t>(at), stops.size() - 2);
    Rgb colour{};
    for (std::size_t c = 0; c < 3; ++c)
        colour[c] = stops[below][c] +
                    (at - double(below)) * (stops[below + 1][c] - stops[below][c]);
    return colour;
}

void requireValid(const View& view) {
    requireInRange("pitch_deg", view.pitch_deg, -90.0, 90.0);
    requireInRange("sigmas", view.sigmas, 0.1, 10.0);
    requireInRange("cut", view.cut, 0.0, 0.99);
    requireInRange("width_px", view.width_px, 16, 8192);
}

Eigen::Matrix3d viewAxes(const View& view) {
    const double yaw = view.yaw_deg * M_PI / 180, pitch = view.pitch_deg * M_PI / 180;
    const Eigen::Vector3d away(std::cos(pitch) * std::cos(yaw),
                               std::cos(pitch) * std::sin(yaw), -std::sin(pitch));
    const Eigen::Vector3d right(std::sin(yaw), -std::cos(yaw), 0.0);
    Eigen::Matrix3d axes;
    axes << right.transpose(), away.cross(right).transpose(), away.transpose();
    return axes;
}

Canvas::Canvas(const Frame& frame, const View& view)
    : frame_(frame), width_(view.width_px) {
    const Eigen::Vector3d size = frame.high - frame.low;
    const Eigen::Vector3d centre = 0.5 * (frame.low + frame.high);
    const double margin = kMargin * width_;
    scale_ = std::min((width_ - 2 * margin) / std::max(size.x(), 1e-6),
                      (kMaxHeight_px - 2 * margin) / std::max(size.y(), 1e-6));
    height_ = std::max(1, static_cast<int>(std::ceil(size.y() * scale_ + 2 * margin)));
    left_ = centre.x() - 0.5 * width_ / scale_;
    top_ = centre.y() - 0.5 * height_ / scale_;
    nearest_ = view.cut > 0.0 ? frame.low.z() + view.cut * size.z() : -kInfinity;
    pixels_.assign(index(0, height_), {kInfinity, {}, 0.0});
}

Canvas::Patch Canvas::patch(const Eigen::Vector3d& centre, double halfWidth_m,
                            double halfHeight_m) const {
    return {clampedPixel((centre.x() - halfWidth_m - left_) * scale_, 0, width_),
            clampedPixel((centre.y() - halfHeight_m - top_) * scale_, 0, height_),
            clampedPixel((centre.x() + halfWidth_m - left_) * scale_, -1, width_ - 1),
            clampedPixel((centre.y() + halfHeight_m - top_) * scale_, -1, height_ - 1)};
}

Eigen::Vector2d Canvas::offset(int x, int y, const Eigen::Vector3d& centre) const {
    return {left_ + (x + 0.5) / scale_ - centre.x(),
            top_ + (y + 0.5) / scale_ - centre.y()};
}

Rgb Canvas::colourOf(double height_m) const {
    // Steps that are hard to see, and few enough colours for a palette: 19 heights in 13
    // shades, and the background.
    constexpr double steps = 18;
    const double span = std::max(frame_.highest_m - frame_.lowest_m, 1e-6);
    const double share = std::clamp((height_m - frame_.lowest_m) / span, 0.0, 1.0);
    return scaleColour(std::round(share * steps) / steps);
}

void Canvas::put(int x, int y, double depth_m, const Rgb& colour, double brightness) {
    Pixel& pixel = pixels_[index(x, y)];
    if (depth_m >= nearest_ && depth_m < pixel.depth_m)
        pixel = {depth_m, colour, brightness};
}

void Canvas::shadeGaps(double gap_m) {
    constexpr std::array<std::pair<int, int>, 4> neighbours = {
        {{-1, 0}, {1, 0}, {0, -1}, {0, 1}}};
    for (int y = 0; y < height_; ++y)
        for (int x = 0; x < width_; ++x) {
            Pixel& pixel = pixels_[index(x, y)];
            double before = 0.0;
            for (const auto& [dx, dy] : neighbours) {
                const int nx = x + dx, ny = y + dy;
                if (nx < 0 || ny < 0 || nx >= width_ || ny >= height_) continue;
                const double gap = pixel.depth_m - pixels_[index(nx, ny)].depth_m;
                if (std::isfinite(gap) && gap > 0.0) before += std::min(gap / gap_m, 1.0);
            }
            pixel.brightness *= 1.0 - 0.15 * before;
        }
}

Picture Canvas::take() {
    constexpr double brightnessSteps = 20, darkest = 0.4;
    Picture picture;
    picture.width_px = width_;
    picture.height_px = height_;
    picture.rgb.assign(3 * pixels_.size(), 255);
    for (std::size_t i = 0; i < pixels_.size(); ++i) {
        const Pixel& pixel = pixels_[i];
        if (pixel.depth_m == kInfinity) continue;
        const double brightness =
            std::round(std::clamp(pixel.brightness, darkest, 1.0) * brightnessSteps) /
            brightnessSteps;
        for (std::size_t k = 0; k < 3; ++k)
            picture.rgb[3 * i + k] = static_cast<std::uint8_t>(
                255 * std::clamp(brightness * pixel.colour[k], 0.0, 1.0));
    }
    return picture;
}

}  // namespace hgmm::evaluation
