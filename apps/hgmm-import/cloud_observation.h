#pragma once
#include <hgmm/scan.h>
#include <mrpt/obs/CObservationPointCloud.h>

#include <cstddef>

#include "pcd_reader.h"

namespace hgmm::importer {

/// A point cloud as an observation, and how many points were left out.
struct CloudObservation {
    mrpt::obs::CObservationPointCloud::Ptr observation;
    std::size_t droppedPoints = 0;
};

/// Points given in a frame, as an observation of the sensor at T_frame_sensor in it: points
/// are re-expressed in the sensor frame, and sensorPose becomes T_frame_sensor. The cloud
/// is a coloured one if there are colours, else one with intensities (as they are,
/// 0 if not finite) if there are any, else plain. Points that are all zero in the given
/// frame (no return) or not finite are left out.
CloudObservation makeCloudObservation(const PcdCloud& cloud_frame,
                                      const Pose& T_frame_sensor);

}  // namespace hgmm::importer
