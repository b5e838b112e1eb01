#pragma once
#include <hgmm/scan.h>
#include <mrpt/obs/CActionRobotMovement2D.h>
#include <mrpt/obs/CActionRobotMovement3D.h>

#include <random>

namespace hgmm::importer {

/// Standard deviations of the odometry that is made from the poses, per increment.
struct OdometryNoise {
    double sigmaMetres = 0;   ///< of each of x, y, z [m]
    double sigmaDegrees = 0;  ///< of each of yaw, pitch, roll [deg]
};

/// A movement with noise drawn from the generator.
Pose withNoise(const Pose& T_from_to, const OdometryNoise& noise,
               std::mt19937_64& generator);

/// A movement as 3D odometry. Its covariance is that of the noise, but no less than
/// (1 cm)^2 and (0.5 deg)^2: particle filters spread their particles by it, and a singular
/// one would leave them all at the same place.
mrpt::obs::CActionRobotMovement3D::Ptr makeMotionAction(const Pose& T_from_to,
                                                        const OdometryNoise& noise);

/// A movement's x, y and yaw as 2D odometry, with MRPT's default motion model but for the
/// deviation of the heading, and no surer than the noise.
/// @param turnErrorPerMetre_deg [deg/m]
mrpt::obs::CActionRobotMovement2D::Ptr makePlanarMotionAction(const Pose& T_from_to,
                                                              const OdometryNoise& noise,
                                                              double turnErrorPerMetre_deg);

}  // namespace hgmm::importer
