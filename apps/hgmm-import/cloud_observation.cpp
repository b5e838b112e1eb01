#include "cloud_observation.h"

#include <mrpt/maps/CColouredPointsMap.h>
#include <mrpt/maps/CPointsMapXYZI.h>
#include <mrpt/maps/CSimplePointsMap.h>

#include <cmath>

#include "mrpt_pose.h"

namespace hgmm::importer {
namespace {

template <class PointsMap, class Insert>
std::size_t fill(const RecordedCloud& cloud_frame, const Pose& T_frame_sensor,
                 PointsMap& map, Insert insert) {
    const Pose T_sensor_frame = T_frame_sensor.inverse();
    map.reserve(cloud_frame.points.size());
    for (const auto& point : cloud_frame.points) {
        const Eigen::Vector3f p =
            (T_sensor_frame.R * point.position + T_sensor_frame.t).cast<float>();
        if (point.position.isZero(0) || !p.allFinite()) continue;
        insert(map, p, point);
    }
    return cloud_frame.points.size() - map.size();
}

}  // namespace

CloudObservation makeCloudObservation(const RecordedCloud& cloud_frame,
                                      const Pose& T_frame_sensor,
                                      const ChannelScales& scales, CloudChannel preferred) {
    using Eigen::Vector3f;
    CloudObservation result;
    result.observation = mrpt::obs::CObservationPointCloud::Create();
    result.observation->sensorLabel = "LIDAR";
    result.observation->sensorPose = toMrpt(T_frame_sensor);
    const auto fillInto = [&](auto map, auto insert) {
        result.droppedPoints = fill(cloud_frame, T_frame_sensor, *map, insert);
        result.observation->pointcloud = map;
    };
    const bool colored = cloud_frame.hasColor &&
                         (preferred == CloudChannel::color || !cloud_frame.hasIntensity);
    if (colored)
        fillInto(mrpt::maps::CColouredPointsMap::Create(),
                 [&](auto& map, const Vector3f& p, const RecordedPoint& point) {
                     const auto& [r, g, b] = point.color;
                     map.insertPointRGB(p.x(), p.y(), p.z(), r / scales.color,
                                        g / scales.color, b / scales.color);
                 });
    else if (cloud_frame.hasIntensity)
        fillInto(mrpt::maps::CPointsMapXYZI::Create(), [&](auto& map, const Vector3f& p,
                                                           const RecordedPoint& point) {
            // An XYZI cloud takes the intensity for red, and has no other colour.
            const float value = std::isfinite(point.intensity) ? point.intensity : 0;
            map.insertPointRGB(p.x(), p.y(), p.z(), value / scales.intensity, 0, 0);
        });
    else
        fillInto(mrpt::maps::CSimplePointsMap::Create(),
                 [](auto& map, const Vector3f& p, const RecordedPoint&) {
                     map.insertPointFast(p.x(), p.y(), p.z());
                 });
    return result;
}

}  // namespace hgmm::importer
