#include "observation/image_colour.h"

#include <mrpt/img/TCamera.h>

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <optional>
#include <utility>

#include "hgmm/mrpt_bridge/observation_to_scan.h"

using mrpt::obs::CObservation3DRangeScan;

namespace hgmm::mrpt_bridge {

namespace {

constexpr float kNotMeasured = std::numeric_limits<float>::quiet_NaN();

bool isCalibrated(const mrpt::img::TCamera& camera) {
    return camera.fx() > 0 && camera.fy() > 0;
}

/// A camera that nobody calibrated is taken to be the depth camera.
bool sameIntrinsics(const mrpt::img::TCamera& depth, const mrpt::img::TCamera& colour) {
    if (!isCalibrated(depth) || !isCalibrated(colour)) return true;
    constexpr double maxPixels = 0.5;
    return std::abs(depth.fx() - colour.fx()) < maxPixels &&
           std::abs(depth.fy() - colour.fy()) < maxPixels &&
           std::abs(depth.cx() - colour.cx()) < maxPixels &&
           std::abs(depth.cy() - colour.cy()) < maxPixels;
}

bool isVisibleImage(const CObservation3DRangeScan& o) {
    return o.hasIntensityImage && !o.intensityImage.isEmpty() &&
           o.intensityImageChannel == CObservation3DRangeScan::CH_VISIBLE &&
           o.intensityImage.getPixelDepth() == mrpt::img::PixelDepth::D8U;
}

bool hasSize(const mrpt::img::CImage& image, int rows, int cols) {
    return int(image.getHeight()) == rows && int(image.getWidth()) == cols;
}

/// Whether each depth pixel shows what the pixel of the same place in the image shows.
bool isAligned(const CObservation3DRangeScan& o) {
    if (!o.doDepthAndIntensityCamerasCoincide()) return false;
    if (!sameIntrinsics(o.cameraParams, o.cameraParamsIntensity)) return false;
    const bool byRanges = o.hasRangeImage && o.rangeImage.rows() > 0;
    return hasSize(o.intensityImage,
                   byRanges ? o.rangeImage.rows() : int(o.cameraParams.nrows),
                   byRanges ? o.rangeImage.cols() : int(o.cameraParams.ncols));
}

bool canProject(const CObservation3DRangeScan& o) {
    const mrpt::img::TCamera& camera = o.cameraParamsIntensity;
    return isCalibrated(camera) &&
           hasSize(o.intensityImage, int(camera.nrows), int(camera.ncols));
}

/// By what the lens multiplies `r`, the tangent of a ray's angle to the axis.
double radialFactor(const mrpt::img::TCamera& camera, double r) {
    const auto& k = camera.dist;
    if (camera.distortion == mrpt::img::DistortionModel::kannala_brandt) {
        if (r < 1e-9) return 1.0;
        const double a = std::atan(r), a2 = a * a;
        return a * (1 + a2 * (k[0] + a2 * (k[1] + a2 * (k[4] + a2 * k[5])))) / r;
    }
    const double r2 = r * r;
    return (1 + r2 * (k[0] + r2 * (k[1] + r2 * k[4]))) /
           (1 + r2 * (k[5] + r2 * (k[6] + r2 * k[7])));
}

/// Where a camera sees a point of its optical frame (x right, y down, z forward) [pixel];
/// nothing behind the camera, or farther from the axis than the lens' model holds.
std::optional<Eigen::Vector2d> projected(const Eigen::Vector3d& p_camera,
                                         const mrpt::img::TCamera& camera) {
    if (!(p_camera.z() > 0)) return std::nullopt;
    Eigen::Vector2d ray = p_camera.head<2>() / p_camera.z();
    if (camera.distortion != mrpt::img::DistortionModel::none) {
        const double r = ray.norm(), factor = radialFactor(camera, r);
        // Beyond what it was fitted to, a polynomial may turn back into the image.
        constexpr double further = 1.001;
        if (!(factor > 0 && further * radialFactor(camera, further * r) > factor))
            return std::nullopt;
        Eigen::Vector2d tangential = Eigen::Vector2d::Zero();
        if (camera.distortion == mrpt::img::DistortionModel::plumb_bob) {
            const double t1 = camera.dist[2], t2 = camera.dist[3];
            const double twiceProduct = 2 * ray.x() * ray.y();
            tangential = {t1 * twiceProduct + t2 * (r * r + 2 * ray.x() * ray.x()),
                          t1 * (r * r + 2 * ray.y() * ray.y()) + t2 * twiceProduct};
        }
        ray = factor * ray + tangential;
    }
    const Eigen::Vector2d pixel(camera.cx() + camera.fx() * ray.x(),
                                camera.cy() + camera.fy() * ray.y());
    if (!pixel.allFinite()) return std::nullopt;
    return pixel;
}

/// The image's pixel of a point, if row is not negative, and how far away the point is.
struct ImagePixel {
    int row = -1, col = -1;
    double depth_m = 0;
};

std::vector<ImagePixel> projectAll(const CObservation3DRangeScan& o, const Scan& scan) {
    const Pose T_colour_depth = toPose(o.relativePoseIntensityWRTDepth).inverse();
    const int rows = int(o.intensityImage.getHeight());
    const int cols = int(o.intensityImage.getWidth());
    std::vector<ImagePixel> pixels(scan.size());
    for (std::size_t i = 0; i < scan.size(); ++i) {
        const Eigen::Vector3d p_depth(scan.x[i], scan.y[i], scan.z[i]);
        const Eigen::Vector3d p_colour = T_colour_depth.R * p_depth + T_colour_depth.t;
        const auto at = projected(p_colour, o.cameraParamsIntensity);
        if (!at || !(at->x() > -0.5 && at->x() < cols - 0.5) ||
            !(at->y() > -0.5 && at->y() < rows - 0.5))
            continue;
        pixels[i] = {int(std::lround(at->y())), int(std::lround(at->x())), p_colour.z()};
    }
    return pixels;
}

/// Forgets the pixels of points that nearer ones hide: a depth buffer whose cells are as
/// wide as a depth pixel appears in the image, so that nearer surfaces have no holes.
void dropHidden(const CObservation3DRangeScan& o, std::vector<ImagePixel>& pixels) {
    // Nearer by less than this may be the same surface, seen at a slant.
    constexpr double minGap = 0.05;  // of the depth
    const double magnification =
        isCalibrated(o.cameraParams)
            ? std::max(o.cameraParamsIntensity.fx() / o.cameraParams.fx(),
                       o.cameraParamsIntensity.fy() / o.cameraParams.fy())
            : 1.0;
    const int edge = 1 + int(std::ceil(std::clamp(magnification, 1.0, 64.0)));
    const int cols = int(o.intensityImage.getWidth()) / edge + 1;
    const int rows = int(o.intensityImage.getHeight()) / edge + 1;
    std::vector<double> nearest_m(std::size_t(rows) * cols,
                                  std::numeric_limits<double>::infinity());
    const auto cellOf = [&](const ImagePixel& pixel) {
        return std::size_t(pixel.row / edge) * cols + pixel.col / edge;
    };
    for (const ImagePixel& pixel : pixels)
        if (pixel.row >= 0)
            nearest_m[cellOf(pixel)] = std::min(nearest_m[cellOf(pixel)], pixel.depth_m);
    for (ImagePixel& pixel : pixels)
        if (pixel.row >= 0 && (1 - minGap) * pixel.depth_m > nearest_m[cellOf(pixel)])
            pixel.row = -1;
}

std::vector<ImagePixel> ownPixels(const CObservation3DRangeScan& o,
                                  const std::vector<PixelOfPoint>& pixels) {
    const int rows = int(o.intensityImage.getHeight());
    const int cols = int(o.intensityImage.getWidth());
    std::vector<ImagePixel> own(pixels.size());
    for (std::size_t i = 0; i < pixels.size(); ++i) {
        const PixelOfPoint& p = pixels[i];
        if (p.row >= 0 && p.row < rows && p.col >= 0 && p.col < cols)
            own[i] = {p.row, p.col, 0};
    }
    return own;
}

void addChannel(const mrpt::img::CImage& image, const std::vector<ImagePixel>& pixels,
                const char* name, unsigned imageChannel, Scan& scan) {
    constexpr float scale = 1.F / 255.F;
    Channel channel{name, std::vector<float>(pixels.size(), kNotMeasured)};
    const auto perPixel = unsigned(image.channelCount());
    // Asking CImage for each pixel would take most of the conversion's time.
    const std::uint8_t* line = nullptr;
    int lineRow = -1;
    for (std::size_t i = 0; i < pixels.size(); ++i) {
        if (pixels[i].row < 0) continue;
        if (pixels[i].row != lineRow) {
            lineRow = pixels[i].row;
            line = image.ptrLine<std::uint8_t>(unsigned(lineRow));
        }
        channel.values[i] = scale * line[unsigned(pixels[i].col) * perPixel + imageChannel];
    }
    scan.channels.push_back(std::move(channel));
}

}  // namespace

void addImageColours(const CObservation3DRangeScan& o,
                     const std::vector<PixelOfPoint>& pixels, Scan& scan) {
    if (!isVisibleImage(o)) return;
    const bool aligned = isAligned(o) && pixels.size() == scan.size();
    if (!aligned && !canProject(o)) return;
    std::vector<ImagePixel> seen = aligned ? ownPixels(o, pixels) : projectAll(o, scan);
    if (!aligned) dropHidden(o, seen);
    if (!o.intensityImage.isColor()) {
        addChannel(o.intensityImage, seen, "intensity", 0, scan);
        return;
    }
    const char* names[] = {"r", "g", "b"};  // images are stored blue first
    for (unsigned c = 0; c < 3; ++c)
        addChannel(o.intensityImage, seen, names[c], 2 - c, scan);
}

}  // namespace hgmm::mrpt_bridge
