#pragma once
#include <mrpt/maps/CColouredPointsMap.h>
#include <mrpt/maps/CPointsMapXYZI.h>
#include <mrpt/maps/CSimplePointsMap.h>
#include <mrpt/obs/CObservation2DRangeScan.h>
#include <mrpt/obs/CObservation3DRangeScan.h>
#include <mrpt/obs/CObservationPointCloud.h>
#include <mrpt/obs/CObservationRotatingScan.h>
#include <mrpt/obs/CObservationVelodyneScan.h>
#include <mrpt/obs/CRawlog.h>
#include <mrpt/poses/CPose3D.h>

#include <cmath>
#include <memory>
#include <string>
#include <vector>

/// Small observations of every supported type, with points that vary with range and
/// direction.
namespace observations {

inline const char* datasets() {
    return "/usr/share/mrpt/datasets/";
}

/// Distance to the walls of a room of 8 x 6 m seen from its middle, in direction `azimuth`.
inline double wallRange(double azimuth) {
    return std::min(4.0 / std::max(1e-9, std::abs(std::cos(azimuth))),
                    3.0 / std::max(1e-9, std::abs(std::sin(azimuth))));
}

inline mrpt::obs::CObservation2DRangeScan::Ptr laser(std::size_t rays = 181) {
    auto o = mrpt::obs::CObservation2DRangeScan::Create();
    o->aperture = static_cast<float>(M_PI);
    o->resizeScanAndAssign(rays, 0.F, false);
    for (std::size_t i = 0; i < rays; ++i) {
        o->setScanRange(i, static_cast<float>(wallRange(o->getScanAngle(i))));
        o->setScanRangeValidity(i, true);
    }
    return o;
}

inline mrpt::obs::CObservation3DRangeScan::Ptr depthImage(int rows = 48, int cols = 64) {
    auto o = mrpt::obs::CObservation3DRangeScan::Create();
    o->cameraParams.setIntrinsicParamsFromValues(60.0, 62.0, 31.0, 25.0);
    o->cameraParams.ncols = cols;
    o->cameraParams.nrows = rows;
    o->hasRangeImage = true;
    o->rangeImage_setSize(rows, cols);
    for (int row = 0; row < rows; ++row)
        for (int col = 0; col < cols; ++col)
            o->rangeImage(row, col) = static_cast<uint16_t>(2000 + 9 * col + 3 * row);
    return o;
}

template <typename Points = mrpt::maps::CSimplePointsMap>
inline std::shared_ptr<Points> wallPoints() {
    auto points = std::make_shared<Points>();
    for (int i = 0; i < 30; ++i)
        for (int k = 0; k < 20; ++k)
            points->insertPoint(3.F + 0.01F * i, -1.F + 0.07F * i, 0.1F * k);
    return points;
}

inline mrpt::obs::CObservationPointCloud::Ptr cloud() {
    auto o = mrpt::obs::CObservationPointCloud::Create();
    o->pointcloud = wallPoints();
    return o;
}

inline mrpt::obs::CObservationVelodyneScan::Ptr velodyne() {
    mrpt::obs::CRawlog log;
    if (!log.loadFromRawLogFile(std::string(datasets()) + "test_velodyne_VLP16.rawlog"))
        return {};
    return std::dynamic_pointer_cast<mrpt::obs::CObservationVelodyneScan>(
        log.getAsObservation(0));
}

/// A revolution of a VLP-16. MRPT 2.14 does not read rotating scans that earlier releases
/// wrote, those of its own datasets included; it converts the packets that they came from.
inline mrpt::obs::CObservationRotatingScan::Ptr recordedRotating() {
#if HGMM_MRPT_HAS_NEAREST_NEIGHBOURS
    auto converted = mrpt::obs::CObservationRotatingScan::Create();
    converted->fromVelodyne(*velodyne());
    return converted;
#else
    mrpt::obs::CRawlog log;
    if (!log.loadFromRawLogFile(std::string(datasets()) + "rot_scan_velodyne.rawlog"))
        return {};
    return std::dynamic_pointer_cast<mrpt::obs::CObservationRotatingScan>(
        log.getAsObservation(0));
#endif
}

/// As the class is documented: columns from startAzimuth over azimuthSpan,
/// counter-clockwise.
inline mrpt::obs::CObservationRotatingScan::Ptr rotating(uint16_t rows,
                                                         uint16_t columns = 361) {
    auto o = mrpt::obs::CObservationRotatingScan::Create();
    o->rowCount = rows;
    o->columnCount = columns;
    o->rangeResolution = 0.002;
    o->startAzimuth = -M_PI / 2;
    o->azimuthSpan = M_PI;
    o->rangeImage.resize(rows, columns);
    for (int row = 0; row < rows; ++row)
        for (int col = 0; col < columns; ++col)
            o->rangeImage(row, col) = static_cast<uint16_t>(
                wallRange(o->startAzimuth + o->azimuthSpan * col / (columns - 1)) / 0.002);
    return o;
}

/// One of each type, by name.
inline std::vector<std::pair<std::string, mrpt::obs::CObservation::Ptr>> all() {
    return {{"2D", laser()},           {"3D", depthImage()},
            {"cloud", cloud()},        {"velodyne", velodyne()},
            {"rotating", rotating(1)}, {"VLP-16", rotating(16)},
            {"HDL-32E", rotating(32)}, {"recorded", recordedRotating()}};
}

}  // namespace observations
