#include "observation/scan_readers.h"

namespace hgmm::mrpt_bridge {

bool readScan(const mrpt::obs::CObservation2DRangeScan& o, Channels channels, Scan& scan) {
    const std::size_t rays = o.getScanSize();
    ScanWriter writer(scan, channels, {});
    writer.reserve(rays);
    // A sweeping laser turns about its y axis, from sensorPose on, while it scans.
    const double pitchStep = rays > 1 ? o.deltaPitch / (rays - 1.0) : 0.0;
    const double azimuthStep = rays > 1 ? o.aperture / (rays - 1.0) : 0.0;
    const double direction = o.rightToLeft ? 1.0 : -1.0;
    for (std::size_t i = 0; i < rays; ++i) {
        const float range = o.getScanRange(i);
        if (!o.getScanRangeValidity(i) || !(range > 0.F)) continue;
        const double azimuth = direction * (azimuthStep * i - 0.5 * o.aperture);
        const double forward = range * std::cos(azimuth), pitch = pitchStep * i;
        writer.pushBack(static_cast<float>(forward * std::cos(pitch)),
                        static_cast<float>(range * std::sin(azimuth)),
                        static_cast<float>(-forward * std::sin(pitch)));
    }
    return true;
}

}  // namespace hgmm::mrpt_bridge
