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

/// Scans, one after the other, in the order of time.
class ScanSource {
 public:
    virtual ~ScanSource() = default;
    /// Nothing at the end, or after Ctrl-C. Throws std::runtime_error saying what is wrong
    /// with the input.
    virtual std::optional<TimedScan> next() = 0;
};

/// The scans of one sensor of a rawlog.
/// @param sensorLabel nothing: the sensor of the first scan; said on stderr, of several
std::unique_ptr<ScanSource> openRawlog(const std::string& file,
                                       const std::optional<std::string>& sensorLabel);

/// Scans from stdin, as docs/hgmm-localise.md describes them.
std::unique_ptr<ScanSource> openStandardInput();

}  // namespace localise
