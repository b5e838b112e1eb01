#include "sources/embed.h"

#include <mrpt/obs/CObservation3DRangeScan.h>
#include <mrpt/obs/CObservationPointCloud.h>

#include <stdexcept>

namespace hgmm::importer {
namespace {

using mrpt::obs::CObservation3DRangeScan;
using mrpt::obs::CObservationPointCloud;

void embedImage(mrpt::img::CImage& image) {
    if (!image.isExternallyStored()) return;
    std::string file;
    image.getExternalStorageFileAbsolutePath(file);
    mrpt::img::CImage loaded;
    if (!loaded.loadFromFile(file)) throw std::runtime_error(file + ": cannot be read");
    image = loaded;
}

void embedFields(CObservation3DRangeScan& scan) {
    scan.load();
    scan.points3D_overrideExternalStoredFlag(false);
    scan.rangeImage_forceResetExternalStorage();
    if (scan.hasIntensityImage) embedImage(scan.intensityImage);
    if (scan.hasConfidenceImage) embedImage(scan.confidenceImage);
}

void embedCloud(CObservationPointCloud& scan) {
    if (!scan.isExternallyStored()) return;
    scan.load();
    CObservationPointCloud inMemory;
    inMemory.timestamp = scan.timestamp;
    inMemory.sensorLabel = scan.sensorLabel;
    inMemory.sensorPose = scan.sensorPose;
    inMemory.pointcloud = scan.pointcloud;
    scan = inMemory;
}

}  // namespace

void embed(mrpt::obs::CObservation& observation) {
    if (auto* depth = dynamic_cast<CObservation3DRangeScan*>(&observation))
        embedFields(*depth);
    if (auto* cloud = dynamic_cast<CObservationPointCloud*>(&observation))
        embedCloud(*cloud);
}

}  // namespace hgmm::importer
