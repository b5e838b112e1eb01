#include <mrpt/maps/CColouredPointsMap.h>
#include <mrpt/maps/CPointsMapXYZI.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "hgmm/mrpt_bridge/mrpt_compat.h"
#include "observation/scan_readers.h"

using namespace mrpt::obs;

namespace hgmm::mrpt_bridge {

namespace {

/// Calls push(i, x, y, z) for all points of a cloud.
template <typename Push>
void forEachPoint(const mrpt::maps::CPointsMap& cloud, Push&& push) {
    const auto& x = cloud.getPointsBufferRef_x();
    const auto& y = cloud.getPointsBufferRef_y();
    const auto& z = cloud.getPointsBufferRef_z();
    for (std::size_t i = 0; i < x.size(); ++i) push(i, x[i], y[i], z[i]);
}

/// A value in [0, 1], or NaN, "not measured", for one that is not finite.
float measured(float value) {
    return std::isfinite(value) ? std::clamp(value, 0.F, 1.F)
                                : std::numeric_limits<float>::quiet_NaN();
}

/// What a cloud's intensities are to be multiplied by. MRPT asks for [0, 1], but drivers
/// and files also hold the counts of 8 or 16 bits; which it is shows in the largest.
template <typename Intensities>
float intensityScale(const Intensities& intensities) {
    float largest = 0.F;
    for (const float value : intensities)
        if (std::isfinite(value)) largest = std::max(largest, value);
    return largest <= 1.F ? 1.F : largest <= 255.F ? 1.F / 255.F : 1.F / 65535.F;
}

void readCloud(const mrpt::maps::CPointsMap& cloud, Channels channels, Scan& scan) {
    const auto* coloured = dynamic_cast<const mrpt::maps::CColouredPointsMap*>(&cloud);
    if (const auto* intensities = intensitiesOf<mrpt::maps::CPointsMapXYZI>(cloud)) {
        ScanWriter writer(scan, channels, {"intensity"});
        writer.reserve(cloud.size());
        const float scale = intensityScale(*intensities);
        forEachPoint(cloud, [&](std::size_t i, float x, float y, float z) {
            writer.pushBack(x, y, z, measured(scale * (*intensities)[i]));
        });
    } else if (coloured && hasColours(*coloured)) {
        ScanWriter writer(scan, channels, {"r", "g", "b"});
        writer.reserve(cloud.size());
        forEachPoint(cloud, [&](std::size_t i, float x, float y, float z) {
            float r = 0, g = 0, b = 0;
            coloured->getPointColor_fast(i, r, g, b);
            writer.pushBack(x, y, z, measured(r), measured(g), measured(b));
        });
    } else {
        ScanWriter writer(scan, channels, {});
        writer.reserve(cloud.size());
        forEachPoint(cloud, [&](std::size_t, float x, float y, float z) {
            writer.pushBack(x, y, z);
        });
    }
}

void readCloud(const CObservationVelodyneScan::TPointCloud& cloud, Channels channels,
               Scan& scan) {
    constexpr float scale = 1.F / 255.F;
    const bool bright = cloud.intensity.size() == cloud.size();
    ScanWriter writer(scan, bright ? channels : Channels::none, {"intensity"});
    writer.reserve(cloud.size());
    for (std::size_t i = 0; i < cloud.size(); ++i)
        if (bright)
            writer.pushBack(cloud.x[i], cloud.y[i], cloud.z[i], scale * cloud.intensity[i]);
        else
            writer.pushBack(cloud.x[i], cloud.y[i], cloud.z[i]);
}

}  // namespace

bool readScan(const CObservationPointCloud& o, Channels channels, const ReadingParams&,
              Scan& scan) {
    std::unique_lock<std::mutex> lock;
    if (o.isExternallyStored()) lock = std::unique_lock<std::mutex>(externalStorageMutex());
    const bool unloadAfter = o.isExternallyStored() && !o.pointcloud;
    o.load();
    if (o.pointcloud) readCloud(*o.pointcloud, channels, scan);
    if (unloadAfter) o.unload();
    return true;
}

bool canRead(const CObservationVelodyneScan& o) {
    return o.point_cloud.size() > 0 || o.scan_packets.empty() || !o.calibration.empty();
}

bool readScan(const CObservationVelodyneScan& o, Channels channels, const ReadingParams&,
              Scan& scan) {
    if (o.point_cloud.size() > 0) {
        readCloud(o.point_cloud, channels, scan);
        return true;
    }
    if (o.scan_packets.empty()) return true;
    if (!canRead(o)) {
        warnOnce("CObservationVelodyneScan '" + o.sensorLabel +
                 "' has packets but no calibration: ignored.");
        return false;
    }
    CObservationVelodyneScan copy = o;
    CObservationVelodyneScan::TGeneratePointCloudParameters params;
    params.minDistance = 0;  // the sensor's own minRange applies
    copy.generatePointCloud(params);
    readCloud(copy.point_cloud, channels, scan);
    return true;
}

}  // namespace hgmm::mrpt_bridge
