#include "observation/sensor_range.h"

#include <algorithm>
#include <cmath>

namespace hgmm::mrpt_bridge {

SensorRange::SensorRange(double maxRange_m)
    : maxRange_(maxRange_m > 0 && std::isfinite(maxRange_m) ? maxRange_m : 0) {}

void SensorRange::clear(const Eigen::Vector3d& direction, double length_m,
                        Scan& scan) const {
    const double length = std::min(length_m, maxRange_);
    if (length > 0 && direction.allFinite())
        scan.clearedRays.push_back(
            {direction.normalized().cast<float>(), static_cast<float>(length)});
}

std::vector<double> rangesBeside(const std::vector<double>& ranges, double none) {
    std::vector<double> beside(ranges.size());
    double latest = 0;
    for (std::size_t i = 0; i < ranges.size(); ++i) {
        beside[i] = latest;
        if (ranges[i] > 0) latest = ranges[i];
    }
    latest = 0;
    for (std::size_t i = ranges.size(); i-- > 0;) {
        beside[i] = std::max(beside[i], latest);
        if (!(beside[i] > 0)) beside[i] = none;
        if (ranges[i] > 0) latest = ranges[i];
    }
    return beside;
}

}  // namespace hgmm::mrpt_bridge
