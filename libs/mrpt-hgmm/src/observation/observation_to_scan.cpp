#include "hgmm/mrpt_bridge/observation_to_scan.h"

#include <iostream>
#include <mutex>
#include <set>

#include "observation/scan_readers.h"

using namespace mrpt::obs;

namespace hgmm::mrpt_bridge {

Pose toPose(const mrpt::poses::CPose3D& pose) {
    Pose result;
    const auto& R = pose.getRotationMatrix();
    for (int row = 0; row < 3; ++row)
        for (int col = 0; col < 3; ++col) result.R(row, col) = R(row, col);
    result.t = {pose.x(), pose.y(), pose.z()};
    return result;
}

mrpt::poses::CPose3D toCPose3D(const Pose& pose) {
    mrpt::math::CMatrixDouble33 R;
    for (int row = 0; row < 3; ++row)
        for (int col = 0; col < 3; ++col) R(row, col) = pose.R(row, col);
    return mrpt::poses::CPose3D(
        R, mrpt::math::CMatrixDouble31({pose.t.x(), pose.t.y(), pose.t.z()}));
}

Pose sensorPoseInMap(const CObservation& observation,
                     const std::optional<mrpt::poses::CPose3D>& robotPose) {
    mrpt::poses::CPose3D sensorPose;
    observation.getSensorPose(sensorPose);
    const Pose T_robot_sensor = toPose(sensorPose);
    return robotPose ? toPose(*robotPose) * T_robot_sensor : T_robot_sensor;
}

std::optional<Scan> observationToScan(const CObservation& observation,
                                      const std::optional<mrpt::poses::CPose3D>& robotPose,
                                      Channels channels, const ReadingParams& reading) {
    Scan scan;
    if (!visitSupported(observation, [&](const auto& o) {
            return readScan(o, channels, reading, scan);
        }))
        return std::nullopt;
    scan.T_map_sensor = sensorPoseInMap(observation, robotPose);
    return scan;
}

bool isSupported(const CObservation& observation) {
    return visitSupported(observation, [](const auto& o) { return canRead(o); });
}

std::mutex& externalStorageMutex() {
    static std::mutex mutex;
    return mutex;
}

void warnOnce(const std::string& message) {
    static std::mutex mutex;
    static std::set<std::string> given;
    const std::lock_guard<std::mutex> lock(mutex);
    if (given.insert(message).second) std::cerr << "[hgmm] " << message << std::endl;
}

}  // namespace hgmm::mrpt_bridge
