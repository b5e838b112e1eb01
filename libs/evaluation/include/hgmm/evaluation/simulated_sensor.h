#pragma once
#include <Eigen/Core>
#include <cstdint>
#include <string>
#include <vector>

#include "hgmm/evaluation/points.h"
#include "hgmm/evaluation/scene.h"
#include "hgmm/evaluation/sensor_kind.h"
#include "hgmm/scan.h"

namespace hgmm::evaluation {

/// A range sensor without noise: where its rays go and how far.
struct SimulatedSensor {
    std::string name;
    SensorKind kind = SensorKind::lidar;
    std::vector<Eigen::Vector3d> directions_sensor;  ///< unit; +X forward, +Z up
    double maxRange_m = 100.0;  ///< farther surfaces give no return [m]
};

/// A rotating lidar whose rings lie evenly between two elevations.
/// @param rings [1], >= 2
/// @param raysPerRing over the whole turn [1], >= 1
SimulatedSensor ringLidar(int rings, double lowest_deg, double highest_deg, int raysPerRing,
                          double maxRange_m = 100.0);

/// A pinhole camera; returns are as far as their ray is long.
/// @param width,height of the image [pixel], >= 1
/// @param openingAngle_deg of the width [deg], in (0, 180)
SimulatedSensor depthCamera(int width, int height, double openingAngle_deg,
                            double maxRange_m = 10.0);

/// A laser whose rays lie in one plane, evenly over an angle about +X, both ends included.
/// @param rays [1], >= 2
SimulatedSensor planarLaser(int rays, double openingAngle_deg, double maxRange_m = 20.0);

/// What spoils the ranges of a scan.
struct RangeErrors {
    double noise_m = 0.0;     ///< Gaussian, one sigma [m], >= 0
    double dustShare = 0.0;   ///< of returns that end on the way instead [1], in [0, 1]
    double dustFrom_m = 0.3;  ///< nearest range of such a return [m]
};

/// One ray of a scan.
struct SimulatedReturn {
    bool hit = false;      ///< whether anything was in range
    double range_m = 0.0;  ///< with errors; maxRange_m without a hit [m]
    SceneHit truth;        ///< without errors; meaningless without a hit
};

/// All rays of a sensor, in the order of directions_sensor. Errors follow (seed, scanIndex)
/// and the number of the ray alone, whatever it meets and however many threads there are.
std::vector<SimulatedReturn> simulateReturns(const Scene& scene,
                                             const SimulatedSensor& sensor,
                                             const Pose& T_map_sensor,
                                             const RangeErrors& errors, std::uint64_t seed,
                                             std::size_t scanIndex);

/// What becomes of rays without a return.
enum class WithoutReturn {
    leftOut,  ///< nothing
    clears    ///< cleared rays of the sensor's range
};

/// The returns as a scan.
Scan scanOf(const std::vector<SimulatedReturn>& returns, const SimulatedSensor& sensor,
            const Pose& T_map_sensor, WithoutReturn withoutReturn);

/// A point of a surface, as a sensor without errors sees it.
struct SurfacePoint {
    Eigen::Vector3d point_map;  ///< [m]
    Part part;
    double incidence;  ///< sine of the angle between ray and surface [1], (0, 1]
};

/// All that a sensor without errors sees from one place.
std::vector<SurfacePoint> idealView(const Scene& scene, const SimulatedSensor& sensor,
                                    const Pose& T_map_sensor);

}  // namespace hgmm::evaluation
