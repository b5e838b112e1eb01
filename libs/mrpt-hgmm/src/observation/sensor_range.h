#pragma once
#include <Eigen/Core>
#include <vector>

#include "hgmm/scan.h"

namespace hgmm::mrpt_bridge {

/// Makes cleared rays of the readings of a sensor that knows how far it sees.
class SensorRange {
 public:
    /// @param maxRange_m one that is not positive and finite is not known: no reading is
    /// beyond it, and rays without return clear nothing
    explicit SensorRange(double maxRange_m);

    /// [m]; 0 if not known
    double max() const { return maxRange_; }
    /// Whether a reading says that nothing is nearer than the sensor sees.
    bool isReached(double range_m) const {
        constexpr double tolerance = 1e-4;  // [maxRange]
        return maxRange_ > 0 && range_m >= (1 - tolerance) * maxRange_;
    }
    /// Adds a ray that is clear up to `length_m`, or as far as the sensor sees.
    /// @param direction in the sensor frame, of any length
    void clear(const Eigen::Vector3d& direction, double length_m, Scan& scan) const;
    /// As far as the sensor sees.
    void clear(const Eigen::Vector3d& direction, Scan& scan) const {
        clear(direction, maxRange_, scan);
    }

 private:
    double maxRange_;  // [m]; 0 if not known
};

/// How far the sensor saw beside each ray of a row: the longer of the readings of the
/// nearest rays on either side that have one; `none` if no ray has. A hole in a wall is no
/// deeper than the wall is far, for what one can tell.
/// @param ranges of the rays in their order [m]; 0 for those without a reading
std::vector<double> rangesBeside(const std::vector<double>& ranges, double none);

}  // namespace hgmm::mrpt_bridge
