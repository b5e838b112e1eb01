#include <mrpt/obs/VelodyneCalibration.h>

#include <vector>

#include "observation/scan_readers.h"

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

void readImage(const CObservationRotatingScan& o, const std::vector<double>& elevations,
               Channels channels, const ReadingParams& reading, Scan& scan) {
    const bool bright =
        o.intensityImage.rows() == o.rowCount && o.intensityImage.cols() == o.columnCount;
    const Azimuths azimuth = azimuths(o);
    const SensorRange sensor(o.maxRange);
    ScanWriter writer(scan, bright ? channels : Channels::none, {"intensity"});
    for (int col = 0; col < o.columnCount; ++col) {
        const double angle = azimuth.first + col * azimuth.step;
        const double c = std::cos(angle), s = std::sin(angle);
        const auto pointAt = [&](double elevation, double range) -> Eigen::Vector3d {
            const double flat = range * std::cos(elevation);
            return {flat * c, flat * s, range * std::sin(elevation)};
        };
        const bool clears = reading.considerNoReturnsAsFreeSpace && wasFired(o, col);
        for (int row = 0; row < o.rowCount; ++row) {
            const auto raw = o.rangeImage(row, col);
            if (raw == 0 && !clears) continue;
            const double range = raw * o.rangeResolution;
            if (raw == 0) {
                sensor.clearShare(pointAt(elevations[row], 1.0), reading, scan);
            } else if (sensor.isReached(range)) {
                sensor.clearAll(pointAt(elevations[row], 1.0), scan);
            } else {
                const Eigen::Vector3f p = pointAt(elevations[row], range).cast<float>();
                if (bright)
                    writer.pushBack(p.x(), p.y(), p.z(),
                                    o.intensityImage(row, col) / 255.F);
                else
                    writer.pushBack(p.x(), p.y(), p.z());
            }
        }
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
    readImage(o, elevations, channels, reading, scan);
    return true;
}

}  // namespace hgmm::mrpt_bridge
