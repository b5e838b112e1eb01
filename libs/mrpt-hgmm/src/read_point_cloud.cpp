#include <mrpt/maps/CColouredPointsMap.h>
#include <mrpt/maps/CPointsMapXYZI.h>

#include "scan_readers.h"

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

void readCloud(const mrpt::maps::CPointsMap& cloud, Scan& scan) {
    if (const auto* xyzi = dynamic_cast<const mrpt::maps::CPointsMapXYZI*>(&cloud)) {
        ScanWriter writer(scan, {"intensity"});
        writer.reserve(cloud.size());
        forEachPoint(cloud, [&](std::size_t i, float x, float y, float z) {
            writer.pushBack(x, y, z, xyzi->getPointIntensity_fast(i));
        });
    } else if (const auto* coloured =
                   dynamic_cast<const mrpt::maps::CColouredPointsMap*>(&cloud)) {
        ScanWriter writer(scan, {"r", "g", "b"});
        writer.reserve(cloud.size());
        forEachPoint(cloud, [&](std::size_t i, float x, float y, float z) {
            float r = 0, g = 0, b = 0;
            coloured->getPointColor_fast(i, r, g, b);
            writer.pushBack(x, y, z, r, g, b);
        });
    } else {
        ScanWriter writer(scan, {});
        writer.reserve(cloud.size());
        forEachPoint(cloud, [&](std::size_t, float x, float y, float z) {
            writer.pushBack(x, y, z);
        });
    }
}

void readCloud(const CObservationVelodyneScan::TPointCloud& cloud, Scan& scan) {
    constexpr float scale = 1.F / 255.F;
    const bool bright = cloud.intensity.size() == cloud.size();
    ScanWriter writer(scan, {"intensity"});
    writer.reserve(cloud.size());
    for (std::size_t i = 0; i < cloud.size(); ++i)
        writer.pushBack(cloud.x[i], cloud.y[i], cloud.z[i],
                        bright ? scale * cloud.intensity[i] : 0.F);
}

}  // namespace

bool readScan(const CObservationPointCloud& o, Scan& scan) {
    const bool unloadAfter = o.isExternallyStored() && !o.pointcloud;
    o.load();
    if (o.pointcloud) readCloud(*o.pointcloud, scan);
    if (unloadAfter) o.unload();
    return true;
}

bool canRead(const CObservationVelodyneScan& o) {
    return o.point_cloud.size() > 0 || o.scan_packets.empty() || !o.calibration.empty();
}

bool readScan(const CObservationVelodyneScan& o, Scan& scan) {
    if (o.point_cloud.size() > 0) {
        readCloud(o.point_cloud, scan);
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
    readCloud(copy.point_cloud, scan);
    return true;
}

}  // namespace hgmm::mrpt_bridge
