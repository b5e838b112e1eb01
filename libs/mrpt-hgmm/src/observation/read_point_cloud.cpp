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

/// The largest of them that is finite, and whether a value other than 0 and 1 is among
/// them.
struct IntensitySpan {
    float largest = 0.F;
    bool tells = false;
};
template <typename Intensities>
IntensitySpan spanOf(const Intensities& intensities) {
    IntensitySpan span;
    for (const float value : intensities) {
        if (!std::isfinite(value)) continue;
        span.largest = std::max(span.largest, value);
        span.tells = span.tells || (value != 0.F && value != 1.F);
    }
    return span;
}

/// MRPT asks for [0, 1], but drivers and files also hold the counts of 8 or 16 bits; which
/// it is shows in the largest.
double scaleFor(float largest) {
    return largest <= 1.F ? 1.0 : largest <= 255.F ? 255.0 : 65535.0;
}

/// What a cloud's intensities are to be multiplied by.
template <typename Intensities>
float factorFor(const Intensities& intensities, double intensityScale) {
    const float largest = spanOf(intensities).largest;
    if (intensityScale == 0.0) return static_cast<float>(1.0 / scaleFor(largest));
    if (largest > intensityScale)
        warnOnce("intensities exceed the map's intensityScale of " +
                 numberText(intensityScale) + " and count as 1; set intensityScale");
    return static_cast<float>(1.0 / intensityScale);
}

void readCloud(const mrpt::maps::CPointsMap& cloud, Channels channels,
               double intensityScale, Scan& scan) {
    const auto* coloured = dynamic_cast<const mrpt::maps::CColouredPointsMap*>(&cloud);
    if (const auto* intensities = intensitiesOf<mrpt::maps::CPointsMapXYZI>(cloud)) {
        ScanWriter writer(scan, channels, {"intensity"});
        writer.reserve(cloud.size());
        const float factor = factorFor(*intensities, intensityScale);
        forEachPoint(cloud, [&](std::size_t i, float x, float y, float z) {
            writer.pushBack(x, y, z, measured(factor * (*intensities)[i]));
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

/// Calls visit(cloud) with the cloud in memory, if there is one.
template <typename Visitor>
void visitCloud(const CObservationPointCloud& o, Visitor&& visit) {
    std::unique_lock<std::mutex> lock;
    if (o.isExternallyStored()) lock = std::unique_lock<std::mutex>(externalStorageMutex());
    const bool unloadAfter = o.isExternallyStored() && !o.pointcloud;
    o.load();
    if (o.pointcloud) visit(*o.pointcloud);
    if (unloadAfter) o.unload();
}

}  // namespace

std::optional<double> intensityScaleOf(const CObservation& observation) {
    const auto* o = dynamic_cast<const CObservationPointCloud*>(&observation);
    std::optional<double> scale;
    if (o == nullptr) return scale;
    visitCloud(*o, [&](const mrpt::maps::CPointsMap& cloud) {
        const auto* intensities = intensitiesOf<mrpt::maps::CPointsMapXYZI>(cloud);
        if (intensities == nullptr) return;
        const IntensitySpan span = spanOf(*intensities);
        if (span.tells) scale = scaleFor(span.largest);
    });
    return scale;
}

bool readScan(const CObservationPointCloud& o, Channels channels,
              const ReadingParams& reading, Scan& scan) {
    visitCloud(o, [&](const mrpt::maps::CPointsMap& cloud) {
        readCloud(cloud, channels, reading.intensityScale, scan);
    });
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
