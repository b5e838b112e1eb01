#include <algorithm>
#include <cmath>
#include <vector>

#include "observation/scan_readers.h"
#include "observation/sensor_range.h"

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

/// Readings of the rays that are valid, as far as the sensor sees; 0 of others [m].
std::vector<double> validRanges(const CObservation2DRangeScan& o,
                                const SensorRange& sensor) {
    std::vector<double> ranges(o.getScanSize(), 0.0);
    for (std::size_t i = 0; i < ranges.size(); ++i) {
        const double range = o.getScanRange(i);
        if (o.getScanRangeValidity(i) && range > 0)
            ranges[i] = sensor.isReached(range) ? sensor.max() : range;
    }
    return ranges;
}

/// Clears what rays without return say. One that is flagged invalid may hold a range: of
/// what is masked out or too near, which hides what is behind it.
void clearNoReturns(const CObservation2DRangeScan& o, const LaserRays& rayAt,
                    const SensorRange& sensor, double share, Scan& scan) {
    const std::vector<double> valid = validRanges(o, sensor);
    const std::vector<double> beside = rangesBeside(valid, sensor.max());
    for (std::size_t i = 0; i < valid.size(); ++i) {
        const double range = o.getScanRange(i);
        if (valid[i] > 0 || (o.getScanRangeValidity(i) && std::isnan(range))) continue;
        const double clear = share * beside[i];
        sensor.clear(rayAt(i), range > 0 ? std::min(clear, range) : clear, scan);
    }
}

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
        if (!o.getScanRangeValidity(i) || !(range > 0)) continue;
        const Eigen::Vector3d ray = rayAt(i);
        if (sensor.isReached(range))
            sensor.clear(ray, scan);
        else
            writer.pushBack(static_cast<float>(range * ray.x()),
                            static_cast<float>(range * ray.y()),
                            static_cast<float>(range * ray.z()));
    }
    if (reading.considerInvalidRangesAsFreeSpace)
        clearNoReturns(o, rayAt, sensor, reading.clearedShareOfRange, scan);
    return true;
}

}  // namespace hgmm::mrpt_bridge
