#pragma once
#include <string>

namespace hgmm::evaluation {

/// Kinds of sensors that differ in how far they see and how far apart their points lie:
/// defaults of the protocol and of other maps go by it.
enum class SensorKind { depthCamera, lidar };

/// By the MRPT class of the observations: 3D range scans come from depth cameras.
SensorKind sensorKindOf(const std::string& observationClass);

}  // namespace hgmm::evaluation
