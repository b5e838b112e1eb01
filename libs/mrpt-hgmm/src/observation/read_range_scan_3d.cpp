#include <cmath>
#include <vector>

#include "observation/image_colour.h"
#include "observation/scan_readers.h"
#include "observation/sensor_range.h"

using mrpt::obs::CObservation3DRangeScan;

namespace hgmm::mrpt_bridge {

namespace {

/// Loads externally stored fields, and unloads them at the end if they were not in memory;
/// for one thread at a time.
class LoadedScope {
 public:
    explicit LoadedScope(const CObservation3DRangeScan& o) : observation_(o) {
        if (o.points3D_isExternallyStored() || o.rangeImage_isExternallyStored() ||
            o.intensityImage.isExternallyStored())
            lock_ = std::unique_lock<std::mutex>(externalStorageMutex());
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
    std::unique_lock<std::mutex> lock_;
    bool unload_ = false;
};

void readPoints(const CObservation3DRangeScan& o, Channels channels, Scan& scan) {
    const std::size_t n = o.points3D_x.size();
    const bool pixelsKnown = o.points3D_idxs_x.size() == n && o.points3D_idxs_y.size() == n;
    std::vector<PixelOfPoint> pixels;
    const SensorRange sensor(o.maxRange);
    scan.reserve(n);
    for (std::size_t i = 0; i < n; ++i) {
        const float x = o.points3D_x[i], y = o.points3D_y[i], z = o.points3D_z[i];
        if (x == 0 && y == 0 && z == 0) continue;  // MRPT's mark of an invalid point
        if (!std::isfinite(x) || !std::isfinite(y) || !std::isfinite(z)) continue;
        const Eigen::Vector3d point(x, y, z);
        if (sensor.isReached(o.range_is_depth ? point.x() : point.norm())) {
            sensor.clear(point, scan);
            continue;
        }
        scan.pushBack(x, y, z);
        if (pixelsKnown) pixels.push_back({o.points3D_idxs_y[i], o.points3D_idxs_x[i]});
    }
    if (channels == Channels::all) addImageColours(o, pixels, scan);
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

bool readRanges(const CObservation3DRangeScan& o, Channels channels, Scan& scan) {
    if (!(o.cameraParams.fx() > 0 && o.cameraParams.fy() > 0)) {
        warnOnce("CObservation3DRangeScan '" + o.sensorLabel +
                 "' has a range image but no camera calibration (fx, fy): ignored.");
        return false;
    }
    const PixelRays rays(o);
    const SensorRange sensor(o.maxRange);
    std::vector<PixelOfPoint> pixels;
    for (int row = 0; row < o.rangeImage.rows(); ++row)
        for (int col = 0; col < o.rangeImage.cols(); ++col) {
            const auto raw = o.rangeImage(row, col);
            if (raw == 0) continue;
            const double ky = rays.ky(row, col), kz = rays.kz(row, col);
            const double range = double(raw) * o.rangeUnits;
            if (sensor.isReached(range)) {
                sensor.clear({1.0, ky, kz}, scan);
                continue;
            }
            const double x =
                o.range_is_depth ? range : range / std::sqrt(1 + ky * ky + kz * kz);
            if (!std::isfinite(x)) continue;
            scan.pushBack(static_cast<float>(x), static_cast<float>(ky * x),
                          static_cast<float>(kz * x));
            pixels.push_back({row, col});
        }
    if (channels == Channels::all) addImageColours(o, pixels, scan);
    return true;
}

}  // namespace

bool readScan(const CObservation3DRangeScan& o, Channels channels, const ReadingParams&,
              Scan& scan) {
    const LoadedScope loaded(o);
    if (o.hasPoints3D && !o.points3D_x.empty()) {
        readPoints(o, channels, scan);
        return true;
    }
    if (o.hasRangeImage && o.rangeImage.rows() * o.rangeImage.cols() > 0)
        return readRanges(o, channels, scan);
    return true;
}

}  // namespace hgmm::mrpt_bridge
