#include "observation/scan_readers.h"

using mrpt::obs::CObservation2DRangeScan;

namespace hgmm::mrpt_bridge {

namespace {

/// Directions of the rays of a planar laser, or of one that turns about its y axis, from
/// sensorPose on, while it scans.
class LaserRays {
 public:
    explicit LaserRays(const CObservation2DRangeScan& o) : aperture_(o.aperture) {
        const double gaps = static_cast<double>(o.getScanSize()) - 1.0;
        pitchStep_ = gaps > 0 ? o.deltaPitch / gaps : 0.0;
        azimuthStep_ = gaps > 0 ? o.aperture / gaps : 0.0;
        direction_ = o.rightToLeft ? 1.0 : -1.0;
    }
    Eigen::Vector3d operator()(std::size_t i) const {
        const double azimuth = direction_ * (azimuthStep_ * i - 0.5 * aperture_);
        const double forward = std::cos(azimuth), pitch = pitchStep_ * i;
        return {forward * std::cos(pitch), std::sin(azimuth), -forward * std::sin(pitch)};
    }

 private:
    double aperture_, pitchStep_ = 0, azimuthStep_ = 0;  // [rad]
    double direction_ = 1;
};

}  // namespace

bool readScan(const CObservation2DRangeScan& o, Channels channels,
              const ReadingParams& reading, Scan& scan) {
    const std::size_t rays = o.getScanSize();
    ScanWriter writer(scan, channels, {});
    writer.reserve(rays);
    const LaserRays rayAt(o);
    const SensorRange sensor(o.maxRange);
    for (std::size_t i = 0; i < rays; ++i) {
        const double range = o.getScanRange(i);
        const bool isValid = o.getScanRangeValidity(i), hasRange = range > 0.0;
        const Eigen::Vector3d ray = rayAt(i);
        if (isValid && sensor.isReached(range)) {
            sensor.clearAll(ray, scan);
        } else if (isValid && hasRange) {
            writer.pushBack(static_cast<float>(range * ray.x()),
                            static_cast<float>(range * ray.y()),
                            static_cast<float>(range * ray.z()));
        } else if (reading.considerInvalidRangesAsFreeSpace &&
                   !(isValid && std::isnan(range))) {
            sensor.clearShare(ray, reading, scan,
                              hasRange ? range : std::numeric_limits<double>::infinity());
        }
    }
    return true;
}

}  // namespace hgmm::mrpt_bridge
