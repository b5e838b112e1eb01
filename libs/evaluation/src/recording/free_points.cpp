#include "hgmm/evaluation/free_points.h"

#include <cmath>
#include <stdexcept>

#include "hgmm/evaluation/sensor_kind.h"

namespace hgmm::evaluation {

void NearBand::validate() const {
    if (!(min_m >= 0.0 && min_m < max_m && std::isfinite(max_m)))
        throw std::invalid_argument(
            "near must be two distances with 0 <= MIN < MAX, but "
            "is " +
            std::to_string(min_m) + "," + std::to_string(max_m));
}

void FreeBand::validate() const {
    if (!(fromSensor_m >= 0.0 && beforeHit_m >= 0.0 && std::isfinite(fromSensor_m) &&
          std::isfinite(beforeHit_m)))
        throw std::invalid_argument(
            "free-band must be two distances of at least 0, but "
            "is " +
            std::to_string(fromSensor_m) + "," + std::to_string(beforeHit_m));
}

NearBand nearBandOf(const std::string& observationClass) {
    constexpr NearBand depthCamera{0.05, 0.30}, lidar{0.10, 0.60};
    return sensorKindOf(observationClass) == SensorKind::depthCamera ? depthCamera : lidar;
}

std::optional<double> rangeIn(const NearBand& band, double ray_m, double share) {
    if (!(ray_m > band.max_m)) return std::nullopt;
    return ray_m - band.max_m + share * (band.max_m - band.min_m);
}

std::optional<double> rangeIn(const FreeBand& band, double ray_m, double share) {
    const double length_m = ray_m - band.beforeHit_m - band.fromSensor_m;
    if (!(length_m > 0.0)) return std::nullopt;
    return band.fromSensor_m + share * length_m;
}

}  // namespace hgmm::evaluation
