#pragma once
#include <hgmm/scan.h>

#include <optional>
#include <string>
#include <vector>

namespace hgmm::evaluation {

/// A pose and the time at which it held.
struct StampedPose {
    double stamp = 0;  ///< [s], of any epoch
    Pose
        T_world_frame;  ///< frame: whatever the pose file speaks of (sensor, robot, camera)
};

/// Poses in the order of time; stamps never go back.
using Trajectory = std::vector<StampedPose>;

/// Stamps given to poses of files without any: poses (and scans) are so far apart [s].
constexpr double kDefaultPosePeriod = 0.1;

/// Reads a pose file, one pose a line; empty lines and lines that start with '#' are
/// skipped. Lines of 8 numbers are TUM's (`t x y z qx qy qz qw`), lines of 12 KITTI's
/// (upper three rows of the 4x4 pose, row by row), which get the stamps 0,
/// kDefaultPosePeriod, ...; one file must hold one kind only. Quaternions are normalised,
/// and rotation matrices replaced by the nearest rotation. Throws std::runtime_error naming
/// file, line and cause: unreadable or empty file, a wrong count of numbers, a number that
/// is none or not finite, a null quaternion, a matrix that is more than 1e-2 away from a
/// rotation, a stamp that goes back.
Trajectory readTrajectory(const std::string& file);

/// TUM lines: stamps with 6 decimals, positions with 9, quaternions with 12 (qw >= 0).
std::string tumText(const Trajectory& trajectory);

/// Writes TUM lines. The file appears whole or not at all. Throws std::runtime_error naming
/// the file.
void writeTumTrajectory(const std::string& file, const Trajectory& trajectory);

/// Writes KITTI lines with 12 significant digits; stamps are lost. Otherwise as above.
void writeKittiTrajectory(const std::string& file, const Trajectory& trajectory);

/// The pose at a time: interpolated between the neighbours (linear, slerp), or that of the
/// first or last pose outside of the trajectory. Nothing if the nearest pose is more than
/// maxGap [s] away.
std::optional<Pose> poseAt(const Trajectory& trajectory, double stamp, double maxGap);

/// The nearest rotation to a 3x3 matrix (polar decomposition, determinant +1). Throws
/// std::runtime_error if an element differs by more than tolerance, or is not finite.
Eigen::Matrix3d nearestRotation(const Eigen::Matrix3d& matrix, double tolerance = 1e-2);

}  // namespace hgmm::evaluation
