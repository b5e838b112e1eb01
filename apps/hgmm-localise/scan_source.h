#pragma once
#include <memory>
#include <optional>
#include <string>

#include "hgmm/scan.h"
#include "hgmm/tracker.h"

namespace localise {

/// A scan as it was measured, with nothing known of where.
struct TimedScan {
    double time_s = 0.0;
    hgmm::Scan scan;  ///< T_map_sensor is the sensor's pose on the robot
    /// Of the sensor since the scan before; nothing without odometry.
    std::optional<hgmm::MotionIncrement> odometry;
};

/// Scans, one after the other.
class ScanSource {
 public:
    virtual ~ScanSource() = default;
    /// Nothing at the end. Throws std::runtime_error saying what is wrong with the input.
    virtual std::optional<TimedScan> next() = 0;
};

/// All scans of a rawlog, or those of one sensor.
/// @param sensorLabel empty: of all sensors
std::unique_ptr<ScanSource> openRawlog(const std::string& file,
                                       const std::string& sensorLabel);

/// Scans from stdin, as docs/hgmm-localise.md describes them.
std::unique_ptr<ScanSource> openStandardInput();

}  // namespace localise
