#include <mrpt/obs/VelodyneCalibration.h>

#include <cmath>
#include <vector>

#include "observation/scan_readers.h"
#include "observation/sensor_range.h"

using mrpt::obs::CObservationRotatingScan;

namespace hgmm::mrpt_bridge {

namespace {

/// Elevation of each row [rad]; empty if unknown. MRPT 2.5 does not store elevations, so
/// they follow from the model, or from the number of rows if the model is not named.
std::vector<double> rowElevations(const CObservationRotatingScan& o) {
    if (o.rowCount == 1) return {0.0};
    const std::string& model = o.lidarModel;
    const bool unnamed = model.empty() || model == "UNKNOWN_SCANNER";
    const char* calibrationName = nullptr;
    if (o.rowCount == 16 && (unnamed || model == "VLP-16" || model == "VLP16"))
        calibrationName = "VLP16";
    if (o.rowCount == 32 &&
        (unnamed || model == "HDL-32E" || model == "HDL-32" || model == "HDL32"))
        calibrationName = "HDL32";
    if (!calibrationName) return {};
    std::vector<double> elevations;
    for (const auto& laser :
         mrpt::obs::VelodyneCalibration::LoadDefaultCalibration(calibrationName)
             .laser_corrections)
        elevations.push_back(mrpt::DEG2RAD(laser.verticalCorrection));
    return elevations.size() == o.rowCount ? elevations : std::vector<double>{};
}

/// Azimuth of column c is first + c * step [rad], counter-clockwise.
struct Azimuths {
    double first = 0, step = 0;
};

/// Whether a scan comes from CObservationRotatingScan::fromVelodyne of MRPT 2.5, which
/// departs from the class' documentation: it allots one column per return instead of one
/// per firing, so that the first 1/rowCount of the columns hold everything, and it keeps
/// Velodyne's clockwise azimuth.
bool madeFromVelodynePackets(const CObservationRotatingScan& o) {
    constexpr int returnsPerPacket = 12 * 32;
    if (o.rowCount < 2 || o.columnCount % returnsPerPacket != 0) return false;
    for (int col = o.columnCount / o.rowCount; col < o.columnCount; ++col)
        for (int row = 0; row < o.rowCount; ++row)
            if (o.rangeImage(row, col) != 0) return false;
    return true;
}

Azimuths azimuths(const CObservationRotatingScan& o) {
    if (madeFromVelodynePackets(o)) {
        const double firings = double(o.columnCount) / o.rowCount;
        return {-o.startAzimuth, -o.azimuthSpan / firings};
    }
    return {o.startAzimuth,
            o.columnCount > 1 ? o.azimuthSpan / (o.columnCount - 1.0) : 0.0};
}

/// Whether lasers fired at a column. Images that are not full end with columns of zeros,
/// and packets that were lost leave some; a single row cannot tell.
bool wasFired(const CObservationRotatingScan& o, int col) {
    if (o.rowCount == 1) return true;
    for (int row = 0; row < o.rowCount; ++row)
        if (o.rangeImage(row, col) != 0) return true;
    return false;
}

/// How far the sensor saw beside each pixel, row by row [m].
std::vector<std::vector<double>> rangesBesidePixels(const CObservationRotatingScan& o,
                                                    const SensorRange& sensor) {
    std::vector<std::vector<double>> beside(o.rowCount);
    for (int row = 0; row < o.rowCount; ++row) {
        std::vector<double> ranges(o.columnCount);
        for (int col = 0; col < o.columnCount; ++col)
            ranges[col] = o.rangeImage(row, col) * o.rangeResolution;
        beside[row] = rangesBeside(ranges, sensor.max());
    }
    return beside;
}

/// Where a pixel's point lies.
class PixelPoints {
 public:
    PixelPoints(const CObservationRotatingScan& o, const std::vector<double>& elevations) {
        const Azimuths azimuth = azimuths(o);
        for (int col = 0; col < o.columnCount; ++col) {
            const double angle = azimuth.first + col * azimuth.step;
            columns_.push_back({std::cos(angle), std::sin(angle)});
        }
        for (const double angle : elevations)
            rows_.push_back({std::cos(angle), std::sin(angle)});
    }
    Eigen::Vector3d at(int row, int col, double range) const {
        const double flat = range * rows_[row].cosine;
        return {flat * columns_[col].cosine, flat * columns_[col].sine,
                range * rows_[row].sine};
    }

 private:
    struct Angle {
        double cosine, sine;
    };
    std::vector<Angle> rows_, columns_;
};

void clearNoReturns(const CObservationRotatingScan& o, const PixelPoints& points,
                    const SensorRange& sensor, double share, Scan& scan) {
    const auto beside = rangesBesidePixels(o, sensor);
    for (int col = 0; col < o.columnCount; ++col) {
        if (!wasFired(o, col)) continue;
        for (int row = 0; row < o.rowCount; ++row)
            if (o.rangeImage(row, col) == 0)
                sensor.clear(points.at(row, col, 1.0), share * beside[row][col], scan);
    }
}

void readImage(const CObservationRotatingScan& o, const PixelPoints& points,
               const SensorRange& sensor, Channels channels, Scan& scan) {
    const bool bright =
        o.intensityImage.rows() == o.rowCount && o.intensityImage.cols() == o.columnCount;
    ScanWriter writer(scan, bright ? channels : Channels::none, {"intensity"});
    for (int col = 0; col < o.columnCount; ++col)
        for (int row = 0; row < o.rowCount; ++row) {
            const auto raw = o.rangeImage(row, col);
            if (raw == 0) continue;
            const double range = raw * o.rangeResolution;
            const Eigen::Vector3f p = points.at(row, col, range).cast<float>();
            if (sensor.isReached(range))
                sensor.clear(points.at(row, col, 1.0), scan);
            else if (bright)
                writer.pushBack(p.x(), p.y(), p.z(), o.intensityImage(row, col) / 255.F);
            else
                writer.pushBack(p.x(), p.y(), p.z());
        }
}

}  // namespace

bool canRead(const CObservationRotatingScan& o) {
    return o.rowCount == 0 || o.columnCount == 0 || !rowElevations(o).empty();
}

bool readScan(const CObservationRotatingScan& o, Channels channels,
              const ReadingParams& reading, Scan& scan) {
    if (o.rowCount == 0 || o.columnCount == 0) return true;
    if (o.rangeImage.rows() != o.rowCount || o.rangeImage.cols() != o.columnCount) {
        warnOnce("CObservationRotatingScan '" + o.sensorLabel +
                 "': its range image is not rowCount x columnCount: ignored.");
        return false;
    }
    const std::vector<double> elevations = rowElevations(o);
    if (elevations.empty()) {
        warnOnce(
            "CObservationRotatingScan '" + o.sensorLabel + "' of model '" + o.lidarModel +
            "' with " + std::to_string(o.rowCount) +
            " rows is ignored: MRPT stores no elevations, and only single rows, VLP-16 and "
            "HDL-32E are known. Convert it to CObservationPointCloud.");
        return false;
    }
    const PixelPoints points(o, elevations);
    const SensorRange sensor(o.maxRange);
    readImage(o, points, sensor, channels, scan);
    if (reading.considerNoReturnsAsFreeSpace)
        clearNoReturns(o, points, sensor, reading.clearedShareOfRange, scan);
    return true;
}

}  // namespace hgmm::mrpt_bridge
