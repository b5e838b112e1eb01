#include "hgmm/evaluation/render.h"

#include <mrpt/img/CImage.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <limits>
#include <stdexcept>

#include "hgmm/require.h"

namespace hgmm::evaluation {
namespace {

constexpr int kMaxHeight_px = 2000;
constexpr double kMargin = 0.03;  // of the picture's width

using Rgb = std::array<double, 3>;

/// Dark blue to yellow by rising lightness: ordered for every kind of colour vision.
Rgb heightColour(double share) {
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

/// Rows: right, down, away from the viewer.
Eigen::Matrix3d viewAxes(const View& view) {
    const double yaw = view.yaw_deg * M_PI / 180, pitch = view.pitch_deg * M_PI / 180;
    const Eigen::Vector3d away(std::cos(pitch) * std::cos(yaw),
                               std::cos(pitch) * std::sin(yaw), -std::sin(pitch));
    const Eigen::Vector3d right(std::sin(yaw), -std::cos(yaw), 0.0);
    Eigen::Matrix3d axes;
    axes << right.transpose(), away.cross(right).transpose(), away.transpose();
    return axes;
}

struct Extent {
    Eigen::AlignedBox3d view;  // of the means and their ellipsoids, in view axes
    double lowest = std::numeric_limits<double>::infinity(),
           highest = -lowest;  // z of the means
};

class Canvas {
 public:
    Canvas(const Extent& extent, const View& view) : extent_(extent), sigmas_(view.sigmas) {
        const Eigen::Vector3d size = extent.view.sizes();
        picture_.width_px = view.width_px;
        scale_ = view.width_px * (1 - 2 * kMargin) / std::max(size.x(), 1e-6);
        const double margin = kMargin * view.width_px;
        scale_ = std::min(scale_, (kMaxHeight_px - 2 * margin) / std::max(size.y(), 1e-6));
        picture_.height_px = std::max(1, int(std::ceil(size.y() * scale_ + 2 * margin)));
        const std::size_t pixels = std::size_t(picture_.width_px) * picture_.height_px;
        picture_.rgb.assign(3 * pixels, 255);
        depth_.assign(pixels, std::numeric_limits<double>::infinity());
        left_ = extent.view.center().x() - 0.5 * picture_.width_px / scale_;
        top_ = extent.view.center().y() - 0.5 * picture_.height_px / scale_;
        nearest_ = extent.view.min().z() + view.cut * size.z();
    }

    void draw(const Eigen::Vector3d& mean, const Eigen::Matrix3d& covariance,
              const Rgb& colour) {
        const double reach_x = sigmas_ * std::sqrt(covariance(0, 0));
        const double reach_y = sigmas_ * std::sqrt(covariance(1, 1));
        const Eigen::Matrix3d precision = covariance.inverse();
        const int x0 = std::max(0, int((mean.x() - reach_x - left_) * scale_));
        const int x1 =
            std::min(picture_.width_px - 1, int((mean.x() + reach_x - left_) * scale_));
        const int y0 = std::max(0, int((mean.y() - reach_y - top_) * scale_));
        const int y1 =
            std::min(picture_.height_px - 1, int((mean.y() + reach_y - top_) * scale_));
        for (int y = y0; y <= y1; ++y)
            for (int x = x0; x <= x1; ++x)
                shade(x, y,
                      {left_ + (x + 0.5) / scale_ - mean.x(),
                       top_ + (y + 0.5) / scale_ - mean.y()},
                      mean.z(), precision, colour);
    }

    Picture take() { return std::move(picture_); }

 private:
    /// The pixel's ray, `offset` from the mean, meets the ellipsoid d^T P d = sigmas^2
    /// where a quadratic in depth says.
    void shade(int x, int y, const Eigen::Vector2d& offset, double meanDepth,
               const Eigen::Matrix3d& P, const Rgb& colour) {
        const double a = P(2, 2);
        const double b = P(0, 2) * offset.x() + P(1, 2) * offset.y();
        const double c = offset.dot(P.topLeftCorner<2, 2>() * offset) - sigmas_ * sigmas_;
        const double discriminant = b * b - a * c;
        if (discriminant < 0) return;
        const double dz = (-b - std::sqrt(discriminant)) / a;
        const std::size_t pixel = std::size_t(y) * picture_.width_px + x;
        if (meanDepth + dz < nearest_ || meanDepth + dz >= depth_[pixel]) return;
        depth_[pixel] = meanDepth + dz;
        const Eigen::Vector3d normal =
            (P * Eigen::Vector3d(offset.x(), offset.y(), dz)).normalized();
        static const Eigen::Vector3d light = Eigen::Vector3d(-0.4, -0.6, -0.8).normalized();
        const double brightness = 0.45 + 0.55 * std::max(0.0, normal.dot(light));
        for (std::size_t k = 0; k < 3; ++k)
            picture_.rgb[3 * pixel + k] = static_cast<std::uint8_t>(
                255 * std::clamp(brightness * colour[k], 0.0, 1.0));
    }

    Extent extent_;
    double sigmas_;
    double scale_ = 1, left_ = 0, top_ = 0, nearest_ = 0;
    Picture picture_;
    std::vector<double> depth_;
};

}  // namespace

Picture renderEllipsoids(const Mixture<3>& mixture, const View& view) {
    if (mixture.empty()) throw std::invalid_argument("an empty map has no picture");
    requireInRange("pitch_deg", view.pitch_deg, -90.0, 90.0);
    requireInRange("sigmas", view.sigmas, 0.1, 10.0);
    requireInRange("cut", view.cut, 0.0, 0.99);
    requireInRange("width_px", view.width_px, 16, 8192);
    const Eigen::Matrix3d axes = viewAxes(view);

    std::vector<Gaussian<3>> seen;
    seen.reserve(mixture.size());
    Extent extent;
    for (std::size_t i = 0; i < mixture.size(); ++i) {
        Gaussian<3> g = mixture[i];
        extent.lowest = std::min(extent.lowest, g.mean.z());
        extent.highest = std::max(extent.highest, g.mean.z());
        g.mean = axes * g.mean;
        g.covariance = axes * g.covariance * axes.transpose();
        const Eigen::Vector3d reach = view.sigmas * g.covariance.diagonal().array().sqrt();
        extent.view.extend(Eigen::Vector3d(g.mean - reach));
        extent.view.extend(Eigen::Vector3d(g.mean + reach));
        seen.push_back(g);
    }
    Canvas canvas(extent, view);
    const double span = std::max(extent.highest - extent.lowest, 1e-6);
    for (std::size_t i = 0; i < seen.size(); ++i)
        canvas.draw(seen[i].mean, seen[i].covariance,
                    heightColour((mixture.mean[2][i] - extent.lowest) / span));
    return canvas.take();
}

void writePng(const Picture& picture, const std::string& file) {
    mrpt::img::CImage image(static_cast<unsigned>(picture.width_px),
                            static_cast<unsigned>(picture.height_px), mrpt::img::CH_RGB);
    for (int y = 0; y < picture.height_px; ++y)
        for (int x = 0; x < picture.width_px; ++x) {
            const std::uint8_t* rgb =
                &picture.rgb[3 * (std::size_t(y) * picture.width_px + x)];
            image.setPixel(x, y, mrpt::img::TColor(rgb[0], rgb[1], rgb[2]));
        }
    // The extension picks the format, so the temporary name keeps it.
    const std::string partial = file + ".partial.png";
    std::error_code error;
    if (image.saveToFile(partial)) {
        std::filesystem::rename(partial, file, error);
        if (!error) return;
    }
    std::filesystem::remove(partial, error);
    throw std::runtime_error(file + ": cannot be written");
}

}  // namespace hgmm::evaluation
