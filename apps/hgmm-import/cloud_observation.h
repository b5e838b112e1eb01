#pragma once
#include <hgmm/scan.h>
#include <mrpt/obs/CObservationPointCloud.h>

#include <cstddef>

#include "channel_scales.h"
#include "recorded_cloud.h"

namespace hgmm::importer {

/// Which channel a cloud keeps that has both: MRPT has no cloud for two.
enum class CloudChannel { color, intensity };

/// A point cloud as an observation, and how many points were left out.
struct CloudObservation {
    mrpt::obs::CObservationPointCloud::Ptr observation;
    std::size_t droppedPoints = 0;
};

/// Points given in a frame, in metres, as an observation of the sensor at T_frame_sensor in
/// it: points are re-expressed in the sensor frame, and sensorPose becomes T_frame_sensor.
/// The cloud is a coloured one, or one with intensities (0 if not finite), if there are
/// such channels, else plain; values are divided by the scales. Points that are all zero in
/// the given frame (no return) or not finite are left out.
CloudObservation makeCloudObservation(const RecordedCloud& cloud_frame,
                                      const Pose& T_frame_sensor,
                                      const ChannelScales& scales,
                                      CloudChannel preferred = CloudChannel::color);

}  // namespace hgmm::importer
