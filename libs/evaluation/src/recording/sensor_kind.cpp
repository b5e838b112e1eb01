#include "hgmm/evaluation/sensor_kind.h"

namespace hgmm::evaluation {

SensorKind sensorKindOf(const std::string& observationClass) {
    const bool isDepthCamera =
        observationClass.find("CObservation3DRangeScan") != std::string::npos;
    return isDepthCamera ? SensorKind::depthCamera : SensorKind::lidar;
}

}  // namespace hgmm::evaluation
