#include "hgmm/evaluation/planar_observation.h"

namespace hgmm::evaluation {

mrpt::obs::CObservation2DRangeScan planarObservation(
    const std::vector<SimulatedReturn>& returns, const SimulatedSensor& laser,
    double openingAngle_deg, NoReturn noReturn) {
    constexpr double kDegree = 0.017453292519943295;  // [rad]
    mrpt::obs::CObservation2DRangeScan observation;
    observation.aperture = static_cast<float>(openingAngle_deg * kDegree);
    observation.rightToLeft = true;
    observation.maxRange = static_cast<float>(laser.maxRange_m);
    observation.resizeScan(returns.size());
    for (std::size_t i = 0; i < returns.size(); ++i) {
        const bool hit = returns[i].hit;
        const double range_m = hit                                 ? returns[i].range_m
                               : noReturn == NoReturn::invalidZero ? 0.0
                                                                   : laser.maxRange_m;
        observation.setScanRange(i, static_cast<float>(range_m));
        observation.setScanRangeValidity(i, hit || noReturn == NoReturn::validMaxRange);
    }
    return observation;
}

}  // namespace hgmm::evaluation
