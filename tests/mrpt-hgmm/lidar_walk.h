#pragma once
#include <mrpt/io/CFileGZOutputStream.h>
#include <mrpt/maps/CHGMMOccupancyMap.h>
#include <mrpt/maps/CSimplePointsMap.h>
#include <mrpt/obs/CActionCollection.h>
#include <mrpt/obs/CActionRobotMovement3D.h>
#include <mrpt/obs/CObservationPointCloud.h>
#include <mrpt/obs/CSensoryFrame.h>
#include <mrpt/serialization/CArchive.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
#include <random>
#include <string>
#include <utility>

#include "../hgmm/room_scanner.h"
#include "hgmm/mrpt_bridge/observation_to_scan.h"

/// A 3D lidar in a furnished room: a map of it, a log of a walk with noisy 3D motion, and
/// what pf-localization makes of them.
namespace lidar_walk {

using mrpt::poses::CPose3D;

inline constexpr int kScans = 25;

/// Through the furnished room, rising and tilting.
inline CPose3D poseOf(int i) {
    return {-1.0 + 0.08 * i, -0.8 + 0.05 * i,          1.0 + 0.01 * i,
            0.1 + 0.03 * i,  0.05 * std::sin(0.4 * i), 0.05 * std::cos(0.4 * i)};
}

inline hgmm::Scan scanFrom(const CPose3D& pose, unsigned seed) {
    const hgmm::testing::RoomScanner room;
    return room.scan(hgmm::mrpt_bridge::toPose(pose), seed);
}

inline void saveMap(const std::string& file) {
    mrpt::maps::CHGMMOccupancyMap map;
    for (int i = 0; i < 8; ++i)
        map.insertScan(scanFrom(CPose3D(-1.5 + 0.4 * i, -1 + 0.3 * i, 1.2, i, 0, 0),
                                100 + unsigned(i)));
    map.saveToFile(file);
}

inline mrpt::obs::CActionRobotMovement3D motionOf(const CPose3D& step) {
    constexpr double sigma_m = 0.03, sigma_rad = 0.015;
    mrpt::obs::CActionRobotMovement3D action;
    action.estimationMethod = mrpt::obs::CActionRobotMovement3D::emOdometry;
    action.rawOdometryIncrementReading = step;
    action.poseChange.mean = step;
    action.poseChange.cov.setZero();
    for (int i = 0; i < 6; ++i)
        action.poseChange.cov(i, i) = i < 3 ? sigma_m * sigma_m : sigma_rad * sigma_rad;
    return action;
}

/// Pairs of 3D motion, 2 cm and half a degree off, and what the lidar saw.
inline void saveLog(const std::string& file) {
    mrpt::io::CFileGZOutputStream out(file);
    auto archive = mrpt::serialization::archiveFrom(out);
    std::mt19937_64 random(1);
    std::normal_distribution<double> noise;
    for (int i = 0; i < kScans; ++i) {
        CPose3D step = i == 0 ? CPose3D() : poseOf(i) - poseOf(i - 1);
        step = step + CPose3D(0.02 * noise(random), 0.02 * noise(random), 0, 0, 0,
                              0.01 * noise(random));
        mrpt::obs::CActionCollection actions;
        actions.insert(motionOf(step));
        auto cloud = mrpt::maps::CSimplePointsMap::Create();
        const hgmm::Scan scan = scanFrom(poseOf(i), 200 + unsigned(i));
        for (std::size_t k = 0; k < scan.size(); ++k)
            cloud->insertPoint(scan.x[k], scan.y[k], scan.z[k]);
        auto observation = mrpt::obs::CObservationPointCloud::Create();
        observation->pointcloud = cloud;
        mrpt::obs::CSensoryFrame frame;
        frame.insert(observation);
        archive << actions << frame;
    }
}

/// How far the last estimate of a run is from the truth [m], [deg]; infinitely without one.
inline std::pair<double, double> finalError(const std::string& output) {
    constexpr double none = std::numeric_limits<double>::infinity();
    const auto at = output.find("=(", output.rfind("PDF estimation"));
    double x = 0, y = 0, z = 0, yaw = 0, pitch = 0, roll = 0;
    if (at == std::string::npos ||
        std::sscanf(output.c_str() + at, "=(%lf,%lf,%lf,%lfdeg,%lfdeg,%lfdeg", &x, &y, &z,
                    &yaw, &pitch, &roll) != 6)
        return {none, none};
    const CPose3D estimate(x, y, z, mrpt::DEG2RAD(yaw), mrpt::DEG2RAD(pitch),
                           mrpt::DEG2RAD(roll));
    const CPose3D error = estimate - poseOf(kScans - 1);
    const auto R = error.getRotationMatrix();
    const double cosine = 0.5 * (R(0, 0) + R(1, 1) + R(2, 2) - 1);
    return {error.norm(), mrpt::RAD2DEG(std::acos(std::clamp(cosine, -1.0, 1.0)))};
}

}  // namespace lidar_walk
