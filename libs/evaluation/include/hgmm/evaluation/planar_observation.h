#pragma once
#include <mrpt/obs/CObservation2DRangeScan.h>

#include <vector>

#include "hgmm/evaluation/simulated_sensor.h"

namespace hgmm::evaluation {

/// How a planar laser reports a ray that reaches nothing.
enum class NoReturn {
    invalidZero,      ///< flagged invalid, range 0
    invalidMaxRange,  ///< flagged invalid, range = maxRange
    validMaxRange     ///< flagged valid, range = maxRange
};

/// The returns of a planarLaser() as MRPT's observation; its sensor is the robot.
/// @param openingAngle_deg that of the laser [deg]
mrpt::obs::CObservation2DRangeScan planarObservation(
    const std::vector<SimulatedReturn>& returns, const SimulatedSensor& laser,
    double openingAngle_deg, NoReturn noReturn);

}  // namespace hgmm::evaluation
