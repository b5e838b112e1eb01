#pragma once
#include <mrpt/obs/CObservation.h>
#include <mrpt/poses/CPose3D.h>

#include <optional>

#include "hgmm/mrpt_bridge/reading_params.h"
#include "hgmm/params.h"
#include "hgmm/scan.h"

/// Where MRPT's types and the model's meet.
namespace hgmm::mrpt_bridge {

/// The same rigid transform, in double.
Pose toPose(const mrpt::poses::CPose3D& pose);
mrpt::poses::CPose3D toCPose3D(const Pose& pose);

/// T_map_sensor: robotPose (+) sensorPose, the only place where the two are composed.
/// @param robotPose pose of the robot in the map frame; the origin if not given
Pose sensorPoseInMap(const mrpt::obs::CObservation& observation,
                     const std::optional<mrpt::poses::CPose3D>& robotPose);

/// Whether a scan's channels are read: who has no use for them saves more than half of the
/// time that a coloured depth image takes.
enum class Channels { all, none };

/// What a map of these parameters learns from.
inline Channels channelsFor(const MapParams& params) {
    return params.modalities.empty() ? Channels::none : Channels::all;
}

/// Converts an observation to a scan in the sensor's own frame: rays start at 0, +X
/// forward, and T_map_sensor is sensorPoseInMap.
///
/// | observation | points | channels in [0, 1] |
/// | --- | --- | --- |
/// | CObservation2DRangeScan | rays flagged valid; deltaPitch is respected | |
/// | CObservation3DRangeScan | points3D, else the range image | r,g,b or intensity |
/// | CObservationPointCloud | the cloud | intensity (XYZI) or r,g,b (coloured) |
/// | CObservationVelodyneScan | point_cloud, else generated from the packets | intensity |
/// | CObservationRotatingScan | 1 row; 16 rows (VLP-16); 32 rows (HDL-32E) | intensity |
///
/// Returns, pixels and points that are invalid or not finite are no points. Fields in
/// external storage are loaded, and unloaded again if they were not in memory before.
///
/// Cleared rays (Scan::clearedRays) are read where the sensor's maxRange is known:
///
/// | observation | without return: as ReadingParams say | at or beyond maxRange |
/// | --- | --- | --- |
/// | CObservation2DRangeScan | invalid, or range <= 0 | cleared up to maxRange |
/// | CObservation3DRangeScan | zero pixels clear nothing | cleared up to maxRange |
/// | CObservationRotatingScan | range 0 in a column that has others | up to maxRange |
/// | CObservationPointCloud, CObservationVelodyneScan | not told | points as others |
///
/// Rays without return clear a share of the range seen beside them; those flagged invalid
/// no farther than the range that they hold, if any: what is masked out or too near hides
/// what is behind it.
///
/// A channel value that is NaN was not measured. The image of a 3D range scan gives points
/// the colour of their pixel if both cameras coincide and the images have the same size;
/// otherwise points are projected into it by its own pose, intrinsics and distortion, and
/// those outside it or hidden from it have no colour. Intensities of clouds are divided by
/// reading.intensityScale and cut at 1; those of other types are in 8 bits.
///
/// @param robotPose pose of the robot in the map frame; the origin if not given
/// @param reading in range (ReadingParams::validate)
/// @return nothing for types not listed; also, with one message per process on stderr, for
/// rotating scans with other elevations and Velodyne packets without calibration.
/// Throws std::runtime_error if a file of an externally stored field cannot be read.
std::optional<Scan> observationToScan(
    const mrpt::obs::CObservation& observation,
    const std::optional<mrpt::poses::CPose3D>& robotPose = std::nullopt,
    Channels channels = Channels::all, const ReadingParams& reading = {});

/// The scale of a cloud's intensities, 1, 255 or 65535: the first that none of them
/// exceeds. Nothing if the observation has none, or has values that fit any scale: only 0
/// and 1.
std::optional<double> intensityScaleOf(const mrpt::obs::CObservation& observation);

/// Gives intensityScale, where it is 0, the scale of an observation that tells one, and
/// reports it: before the first scan of a map that learns modalities.
void settleIntensityScale(const mrpt::obs::CObservation& observation,
                          ReadingParams& reading);

/// Whether observationToScan knows the type, decided without converting anything.
bool isSupported(const mrpt::obs::CObservation& observation);

}  // namespace hgmm::mrpt_bridge
