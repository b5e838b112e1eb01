#pragma once
#include <hgmm/scan.h>
#include <mrpt/obs/CActionRobotMovement3D.h>

#include <random>

namespace hgmm::importer {

/// Standard deviations of the odometry that is made from the poses, per increment.
struct OdometryNoise {
    double sigmaMetres = 0;   ///< of each of x, y, z [m]
    double sigmaDegrees = 0;  ///< of each of yaw, pitch, roll [deg]
};

/// The movement between two poses as 3D odometry, with noise drawn from the generator. Its
/// covariance is that of the noise, but no less than (1 cm)^2 and (0.5 deg)^2: particle
/// filters spread their particles by it, and a singular one would leave them all at the
/// same place.
mrpt::obs::CActionRobotMovement3D::Ptr makeMotionAction(const Pose& T_from_to,
                                                        const OdometryNoise& noise,
                                                        std::mt19937_64& generator);

}  // namespace hgmm::importer
