#include "rgbd_observation.h"

#include <cstdio>

#include "files.h"
#include "mrpt_pose.h"

namespace hgmm::importer {
namespace {

using mrpt::img::CImage;
using mrpt::obs::CObservation3DRangeScan;

CImage loadImage(const std::filesystem::path& file) {
    CImage image;
    const bool readable = std::filesystem::is_regular_file(file);
    if (!readable || !image.loadFromFile(file.string()) || image.isEmpty())
        failFile(file, "is no readable image; fetch or unpack the file again");
    return image;
}

void readDepth(const std::filesystem::path& file, const DepthFormat& format,
               CObservation3DRangeScan& o) {
    const CImage image = loadImage(file);
    if (image.isColor() || image.getPixelDepth() != mrpt::img::PixelDepth::D16U)
        failFile(file, "is no 16 bit image of one channel, as depth images must be");
    const int rows = static_cast<int>(image.getHeight());
    const int cols = static_cast<int>(image.getWidth());
    o.rangeImage_setSize(rows, cols);
    for (int row = 0; row < rows; ++row) {
        const auto* line = image.ptrLine<std::uint16_t>(static_cast<unsigned>(row));
        for (int col = 0; col < cols; ++col)
            o.rangeImage(row, col) = line[col] == format.alsoInvalid ? 0 : line[col];
    }
    o.hasRangeImage = true;
    o.range_is_depth = true;
    o.rangeUnits = format.metresPerUnit;
    o.maxRange = 65535 * format.metresPerUnit;  // all that the image can say
}

void readColor(const std::filesystem::path& file, CObservation3DRangeScan& o) {
    o.intensityImage = loadImage(file);
    if (o.intensityImage.getPixelDepth() != mrpt::img::PixelDepth::D8U)
        failFile(file, "is no 8 bit image, as colour images must be");
    if (static_cast<int>(o.intensityImage.getHeight()) != o.rangeImage.rows() ||
        static_cast<int>(o.intensityImage.getWidth()) != o.rangeImage.cols())
        failFile(file,
                 "differs in size from the depth image; leave the colour images out, or "
                 "scale them to the depth images");
    o.hasIntensityImage = true;
    o.intensityImageChannel = CObservation3DRangeScan::CH_VISIBLE;
}

}  // namespace

std::string describeScale(const RgbdOptions& options, double usualUnitsPerMetre) {
    char text[80];
    std::snprintf(text, sizeof text, "%g units a metre%s",
                  options.unitsPerMetre.value_or(usualUnitsPerMetre),
                  options.unitsPerMetre ? "" : " (the format's usual)");
    return text;
}

Pose opticalFromMrptCamera() {
    Pose pose;
    pose.R << 0, -1, 0,  //
        0, 0, -1,        //
        1, 0, 0;
    return pose;
}

CObservation3DRangeScan::Ptr makeRgbdObservation(const RgbdFiles& files,
                                                 const Intrinsics& camera,
                                                 const DepthFormat& format) {
    auto o = CObservation3DRangeScan::Create();
    o->sensorLabel = "RGBD";
    o->sensorPose = toMrpt(opticalFromMrptCamera());
    readDepth(files.depth, format, *o);
    if (files.color) readColor(*files.color, *o);
    o->cameraParams.ncols = static_cast<unsigned>(o->rangeImage.cols());
    o->cameraParams.nrows = static_cast<unsigned>(o->rangeImage.rows());
    o->cameraParams.setIntrinsicParamsFromValues(camera.fx, camera.fy, camera.cx,
                                                 camera.cy);
    o->cameraParamsIntensity = o->cameraParams;
    return o;
}

}  // namespace hgmm::importer
