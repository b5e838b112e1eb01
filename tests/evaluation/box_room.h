#pragma once
#include <mrpt/io/CFileGZOutputStream.h>
#include <mrpt/io/CFileOutputStream.h>
#include <mrpt/maps/CSimplePointsMap.h>
#include <mrpt/obs/CActionCollection.h>
#include <mrpt/obs/CActionRobotMovement2D.h>
#include <mrpt/obs/CActionRobotMovement3D.h>
#include <mrpt/obs/CObservation2DRangeScan.h>
#include <mrpt/obs/CObservationOdometry.h>
#include <mrpt/obs/CObservationPointCloud.h>
#include <mrpt/obs/CSensoryFrame.h>
#include <mrpt/poses/CPose3D.h>
#include <mrpt/serialization/CArchive.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <random>
#include <string>
#include <vector>

#include "hgmm/evaluation/trajectory.h"
#include "hgmm/mrpt_bridge/observation_to_scan.h"

/// Recordings of a robot in an empty box room, whose walls are known in closed form.
namespace box_room {

using Entries = std::vector<mrpt::serialization::CSerializable::Ptr>;
using mrpt::poses::CPose3D;

inline const double kHalf_m[3] = {4.0, 3.0, 1.5};  ///< the room is centred at the origin
constexpr double kStart_s = 1.7e9;                 ///< time of the first scan
constexpr double kPeriod_s = 0.1;                  ///< from scan to scan

/// Distance from a point inside to the wall that a ray hits.
inline double rangeToWall(const double* from, const double* direction) {
    double range = 1e9;
    for (int axis = 0; axis < 3; ++axis) {
        if (direction[axis] == 0.0) continue;
        const double wall = direction[axis] > 0 ? kHalf_m[axis] : -kHalf_m[axis];
        range = std::min(range, (wall - from[axis]) / direction[axis]);
    }
    return range;
}

/// Distance of a point to the nearest wall.
inline double distanceToWalls(const Eigen::Vector3d& p) {
    double distance = 1e9;
    for (int axis = 0; axis < 3; ++axis)
        distance = std::min(distance, std::abs(std::abs(p[axis]) - kHalf_m[axis]));
    return distance;
}

inline double timeOfScan(std::size_t i) {
    return kStart_s + kPeriod_s * static_cast<double>(i);
}

/// Where the robot is at scan i: on a small arc, turning.
inline CPose3D robotPose(std::size_t i) {
    const double a = 0.1 * static_cast<double>(i);
    return {0.8 * std::sin(a), 0.5 * (1 - std::cos(a)), 0.0, 0.7 * a, 0.0, 0.0};
}

/// A 3D scan of n rays, evenly over the sphere, taken by a sensor 20 cm above the robot.
inline mrpt::obs::CObservationPointCloud::Ptr pointCloud(const CPose3D& T_map_robot,
                                                         double time_s, std::size_t n,
                                                         double noise_m = 0.005) {
    auto observation = mrpt::obs::CObservationPointCloud::Create();
    observation->timestamp = mrpt::Clock::fromDouble(time_s);
    observation->sensorLabel = "lidar";
    observation->sensorPose = CPose3D(0, 0, 0.2, 0, 0, 0);
    const CPose3D T_map_sensor = T_map_robot + observation->sensorPose;
    const double from[3] = {T_map_sensor.x(), T_map_sensor.y(), T_map_sensor.z()};
    auto cloud = mrpt::maps::CSimplePointsMap::Create();
    std::mt19937_64 engine(static_cast<std::uint64_t>(time_s * 1000));
    std::normal_distribution<double> noise(0.0, noise_m);
    for (std::size_t i = 0; i < n; ++i) {
        const double z =
            1.0 - 2.0 * (static_cast<double>(i) + 0.5) / static_cast<double>(n);
        const double angle = 2.399963229728653 * static_cast<double>(i),
                     r = std::sqrt(1 - z * z);
        const mrpt::math::TPoint3D d_sensor(r * std::cos(angle), r * std::sin(angle), z);
        const auto d_map = T_map_sensor.rotateVector(d_sensor);
        const double direction[3] = {d_map.x, d_map.y, d_map.z};
        const double range = rangeToWall(from, direction) + noise(engine);
        cloud->insertPoint(static_cast<float>(range * d_sensor.x),
                           static_cast<float>(range * d_sensor.y),
                           static_cast<float>(range * d_sensor.z));
    }
    observation->pointcloud = cloud;
    return observation;
}

/// A full-turn 2D scan by a sensor at the robot's origin, beams from -pi to pi.
inline mrpt::obs::CObservation2DRangeScan::Ptr laser(const CPose3D& T_map_robot,
                                                     double time_s, std::size_t n) {
    auto observation = mrpt::obs::CObservation2DRangeScan::Create();
    observation->timestamp = mrpt::Clock::fromDouble(time_s);
    observation->sensorLabel = "laser";
    observation->aperture = static_cast<float>(2 * M_PI);
    observation->rightToLeft = true;
    observation->maxRange = 50.F;
    observation->resizeScan(n);
    const double from[3] = {T_map_robot.x(), T_map_robot.y(), T_map_robot.z()};
    for (std::size_t i = 0; i < n; ++i) {
        const double angle = T_map_robot.yaw() - M_PI +
                             2 * M_PI * static_cast<double>(i) / static_cast<double>(n - 1);
        const double direction[3] = {std::cos(angle), std::sin(angle), 0.0};
        observation->setScanRange(i, static_cast<float>(rangeToWall(from, direction)));
        observation->setScanRangeValidity(i, true);
    }
    return observation;
}

/// Observation format, without poses.
inline Entries observations(std::size_t scans, std::size_t pointsPerScan) {
    Entries entries;
    for (std::size_t i = 0; i < scans; ++i)
        entries.push_back(pointCloud(robotPose(i), timeOfScan(i), pointsPerScan));
    return entries;
}

inline void writeRawlog(const std::string& file, const Entries& entries) {
    mrpt::io::CFileGZOutputStream stream(file);
    auto archive = mrpt::serialization::archiveFrom(stream);
    for (const auto& entry : entries) archive << *entry;
}

inline void writeUncompressedRawlog(const std::string& file, const Entries& entries) {
    mrpt::io::CFileOutputStream stream(file);
    auto archive = mrpt::serialization::archiveFrom(stream);
    for (const auto& entry : entries) archive << *entry;
}

/// True robot poses of the first scans, or poses that drift along x.
/// @param drift_m of each scan against the one before [m]
inline void writePoses(const std::string& file, std::size_t scans, double drift_m = 0) {
    hgmm::evaluation::Trajectory trajectory;
    for (std::size_t i = 0; i < scans; ++i) {
        hgmm::Pose pose = hgmm::mrpt_bridge::toPose(robotPose(i));
        pose.t.x() += drift_m * double(i);
        trajectory.push_back({timeOfScan(i), pose});
    }
    hgmm::evaluation::writeTumTrajectory(file, trajectory);
}

/// Leaves the first part of a file.
inline void truncateFile(const std::string& file, double share) {
    const auto size = static_cast<double>(std::filesystem::file_size(file));
    std::filesystem::resize_file(file, static_cast<std::uintmax_t>(share * size));
}

}  // namespace box_room
