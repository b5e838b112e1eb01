#include <functional>
#include <vector>

#include "scan_readers.h"

using mrpt::obs::CObservation3DRangeScan;

namespace hgmm::mrpt_bridge {

namespace {

/// Loads externally stored fields, and unloads them at the end if they were not in memory.
class LoadedScope {
 public:
    explicit LoadedScope(const CObservation3DRangeScan& o) : observation_(o) {
        const bool pointsOutside = o.points3D_isExternallyStored() && o.points3D_x.empty();
        const bool rangesOutside = o.rangeImage_isExternallyStored() &&
                                   o.rangeImage.rows() * o.rangeImage.cols() == 0;
        unload_ = pointsOutside || rangesOutside;
        o.load();
    }
    ~LoadedScope() {
        if (unload_) observation_.unload();
        if (observation_.intensityImage.isExternallyStored())
            observation_.intensityImage.unload();
    }
    LoadedScope(const LoadedScope&) = delete;
    LoadedScope& operator=(const LoadedScope&) = delete;

 private:
    const CObservation3DRangeScan& observation_;
    bool unload_ = false;
};

enum class Colour { none, grey, rgb };

/// A camera that nobody calibrated (fx = 0) is taken to be the depth camera.
bool sameIntrinsics(const mrpt::img::TCamera& depth, const mrpt::img::TCamera& colour) {
    if (depth.fx() <= 0 || colour.fx() <= 0) return true;
    constexpr double maxPixels = 0.5;
    return std::abs(depth.fx() - colour.fx()) < maxPixels &&
           std::abs(depth.fy() - colour.fy()) < maxPixels &&
           std::abs(depth.cx() - colour.cx()) < maxPixels &&
           std::abs(depth.cy() - colour.cy()) < maxPixels;
}

/// What the intensity image says about the depth pixels, if it shows the same pixels.
Colour alignedColour(const CObservation3DRangeScan& o) {
    if (!o.hasIntensityImage || o.intensityImage.isEmpty()) return Colour::none;
    if (o.intensityImageChannel != CObservation3DRangeScan::CH_VISIBLE) return Colour::none;
    if (!o.doDepthAndIntensityCamerasCoincide()) return Colour::none;
    if (!sameIntrinsics(o.cameraParams, o.cameraParamsIntensity)) return Colour::none;
    if (o.intensityImage.getPixelDepth() != mrpt::img::PixelDepth::D8U) return Colour::none;
    const bool byRanges = o.hasRangeImage && o.rangeImage.rows() > 0;
    const auto rows = byRanges ? o.rangeImage.rows() : int(o.cameraParams.nrows);
    const auto cols = byRanges ? o.rangeImage.cols() : int(o.cameraParams.ncols);
    if (int(o.intensityImage.getHeight()) != rows ||
        int(o.intensityImage.getWidth()) != cols)
        return Colour::none;
    return o.intensityImage.isColor() ? Colour::rgb : Colour::grey;
}

/// Writes points together with the colour of the pixel that they were seen in.
class PixelWriter {
 public:
    PixelWriter(const CObservation3DRangeScan& o, Colour colour, Scan& scan)
        : image_(o.intensityImage), colour_(colour), writer_(scan, channels(colour)) {}

    void reserve(std::size_t n) { writer_.reserve(n); }

    void pushBack(float x, float y, float z, unsigned row, unsigned col) {
        constexpr float scale = 1.F / 255.F;
        const auto value = [&](unsigned channel) {
            return scale * image_.at<uint8_t>(col, row, channel);
        };
        switch (colour_) {  // images are stored blue first
            case Colour::none:
                return writer_.pushBack(x, y, z);
            case Colour::grey:
                return writer_.pushBack(x, y, z, value(0));
            case Colour::rgb:
                return writer_.pushBack(x, y, z, value(2), value(1), value(0));
        }
    }

 private:
    static std::initializer_list<const char*> channels(Colour colour) {
        static constexpr std::initializer_list<const char*> none{}, grey{"intensity"},
            rgb{"r", "g", "b"};
        return colour == Colour::none ? none : colour == Colour::grey ? grey : rgb;
    }

    const mrpt::img::CImage& image_;
    Colour colour_;
    ScanWriter writer_;
};

void readPoints(const CObservation3DRangeScan& o, Scan& scan) {
    const std::size_t n = o.points3D_x.size();
    Colour colour = alignedColour(o);
    if (o.points3D_idxs_x.size() != n || o.points3D_idxs_y.size() != n)
        colour = Colour::none;
    PixelWriter writer(o, colour, scan);
    writer.reserve(n);
    for (std::size_t i = 0; i < n; ++i) {
        const float x = o.points3D_x[i], y = o.points3D_y[i], z = o.points3D_z[i];
        if (x == 0 && y == 0 && z == 0) continue;  // MRPT's mark of an invalid point
        unsigned row = 0, col = 0;
        if (colour != Colour::none) {
            row = o.points3D_idxs_y[i];
            col = o.points3D_idxs_x[i];
            if (row >= o.intensityImage.getHeight() || col >= o.intensityImage.getWidth())
                continue;
        }
        writer.pushBack(x, y, z, row, col);
    }
}

/// Directions (1, ky, kz) of pixels, from MRPT's table if the lens distorts and else
/// directly: the table is kept by MRPT for ever, one per sensor pose.
class PixelRays {
 public:
    explicit PixelRays(const CObservation3DRangeScan& o) : camera_(o.cameraParams) {
        for (const double k : camera_.dist) distorted_ = distorted_ || k != 0;
        distorted_ = distorted_ && camera_.distortion != mrpt::img::DistortionModel::none;
        if (distorted_) table_ = &o.get_unproj_lut();
        cols_ = o.rangeImage.cols();
    }
    double ky(int row, int col) const {
        if (!distorted_) return (camera_.cx() - col) / camera_.fx();
        return table_->Kys[row * cols_ + col] / table_->Kxs[row * cols_ + col];
    }
    double kz(int row, int col) const {
        if (!distorted_) return (camera_.cy() - row) / camera_.fy();
        return table_->Kzs[row * cols_ + col] / table_->Kxs[row * cols_ + col];
    }

 private:
    const mrpt::img::TCamera& camera_;
    const CObservation3DRangeScan::unproject_LUT_t* table_ = nullptr;
    bool distorted_ = false;
    int cols_ = 0;
};

bool readRanges(const CObservation3DRangeScan& o, Scan& scan) {
    if (!(o.cameraParams.fx() > 0 && o.cameraParams.fy() > 0)) {
        warnOnce("CObservation3DRangeScan '" + o.sensorLabel +
                 "' has a range image but no camera calibration (fx, fy): ignored.");
        return false;
    }
    const PixelRays rays(o);
    PixelWriter writer(o, alignedColour(o), scan);
    for (int row = 0; row < o.rangeImage.rows(); ++row)
        for (int col = 0; col < o.rangeImage.cols(); ++col) {
            const auto raw = o.rangeImage(row, col);
            if (raw == 0) continue;
            const double ky = rays.ky(row, col), kz = rays.kz(row, col);
            const double range = double(raw) * o.rangeUnits;
            const double x =
                o.range_is_depth ? range : range / std::sqrt(1 + ky * ky + kz * kz);
            writer.pushBack(static_cast<float>(x), static_cast<float>(ky * x),
                            static_cast<float>(kz * x), row, col);
        }
    return true;
}

}  // namespace

bool readScan(const CObservation3DRangeScan& o, Scan& scan) {
    const LoadedScope loaded(o);
    if (o.hasPoints3D && !o.points3D_x.empty()) {
        readPoints(o, scan);
        return true;
    }
    if (o.hasRangeImage && o.rangeImage.rows() * o.rangeImage.cols() > 0)
        return readRanges(o, scan);
    return true;
}

}  // namespace hgmm::mrpt_bridge
