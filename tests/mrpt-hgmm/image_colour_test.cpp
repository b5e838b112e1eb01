#include <gtest/gtest.h>
#include <mrpt/math/TPoint3D.h>
#include <mrpt/vision/pinhole.h>

#include <cmath>

#include "hgmm/mrpt_bridge/observation_to_scan.h"
#include "observations.h"

// Depth and colour cameras that do not coincide. The image says in red and green which
// column and row was looked up, so that answers are known in closed form.

namespace {

using hgmm::mrpt_bridge::observationToScan;
using mrpt::img::TCamera;
using mrpt::math::TPoint3D;

constexpr int kCols = 120, kRows = 90;

const std::vector<float>& channelOf(const hgmm::Scan& scan, const char* name) {
    for (const auto& c : scan.channels)
        if (c.name == name) return c.values;
    throw std::runtime_error(std::string("no channel ") + name);
}

mrpt::img::CImage numberedImage() {
    mrpt::img::CImage image(kCols, kRows, mrpt::img::CH_RGB);
    for (int row = 0; row < kRows; ++row)
        for (int col = 0; col < kCols; ++col)
            image.setPixel(col, row, (2U * col << 16U) | (2U * row << 8U) | 77U);
    return image;
}

/// A camera beside, above and behind the depth camera, turned a little, with another lens.
mrpt::obs::CObservation3DRangeScan::Ptr pairOfCameras() {
    auto o = observations::depthImage();
    o->hasIntensityImage = true;
    o->intensityImage = numberedImage();
    o->cameraParamsIntensity.setIntrinsicParamsFromValues(100.0, 103.0, 58.0, 47.0);
    o->cameraParamsIntensity.ncols = kCols;
    o->cameraParamsIntensity.nrows = kRows;
    o->relativePoseIntensityWRTDepth =
        mrpt::poses::CPose3D(-0.02, 0.06, 0.03, 0.05, -0.02, 0.0) +
        mrpt::poses::CPose3D(0, 0, 0, -M_PI / 2, 0, -M_PI / 2);
    return o;
}

TPoint3D inColourCamera(const mrpt::obs::CObservation3DRangeScan& o, const hgmm::Scan& scan,
                        std::size_t i) {
    TPoint3D p;
    o.relativePoseIntensityWRTDepth.inverseComposePoint(scan.x[i], scan.y[i], scan.z[i],
                                                        p.x, p.y, p.z);
    return p;
}

bool isInside(double col, double row) {
    return col > -0.5 && row > -0.5 && col < kCols - 0.5 && row < kRows - 0.5;
}

/// Compares all points with expected(point in the colour camera): the pixel, by MRPT's
/// formulas. Returns how many have a colour.
template <typename Expected>
std::size_t expectColours(const mrpt::obs::CObservation3DRangeScan& o,
                          const hgmm::Scan& scan, Expected expected) {
    const auto &r = channelOf(scan, "r"), &g = channelOf(scan, "g"),
               &b = channelOf(scan, "b");
    std::size_t coloured = 0;
    for (std::size_t i = 0; i < scan.size(); ++i) {
        const mrpt::img::TPixelCoordf pixel = expected(inColourCamera(o, scan, i));
        EXPECT_EQ(std::isfinite(r[i]), isInside(pixel.x, pixel.y))
            << pixel.x << ' ' << pixel.y;
        if (!std::isfinite(r[i])) continue;
        ++coloured;
        EXPECT_NEAR(r[i] * 255 / 2, pixel.x, 0.51);
        EXPECT_NEAR(g[i] * 255 / 2, pixel.y, 0.51);
        EXPECT_FLOAT_EQ(b[i], 77.F / 255.F);
    }
    return coloured;
}

TEST(ImageColour, PointsAreProjectedIntoTheImageOfAnotherCamera) {
    const auto o = pairOfCameras();
    const auto scan = observationToScan(*o);
    ASSERT_EQ(scan->size(), 48U * 64U) << "points without colour stay";
    const std::size_t coloured = expectColours(*o, *scan, [&](const TPoint3D& p) {
        return mrpt::img::TPixelCoordf(58.F + 100.F * p.x / p.z, 47.F + 103.F * p.y / p.z);
    });
    EXPECT_GT(coloured, 2000U);
    EXPECT_LT(coloured, scan->size()) << "some are beyond the image's border";
}

TEST(ImageColour, WhoWantsNoChannelsGetsTheSamePointsWithout) {
    using hgmm::mrpt_bridge::Channels;
    const auto o = pairOfCameras();
    const auto with = observationToScan(*o);
    const auto without = observationToScan(*o, std::nullopt, Channels::none);
    EXPECT_EQ(with->channels.size(), 3U);
    EXPECT_TRUE(without->channels.empty());
    EXPECT_EQ(without->x, with->x);
    EXPECT_EQ(without->y, with->y);
    EXPECT_EQ(without->z, with->z);
    const auto cloud = observations::rotating(16);
    cloud->intensityImage.resize(cloud->rowCount, cloud->columnCount);
    cloud->intensityImage.fill(80);
    const auto bright = observationToScan(*cloud);
    const auto plain = observationToScan(*cloud, std::nullopt, Channels::none);
    EXPECT_EQ(bright->channels.size(), 1U);
    EXPECT_TRUE(plain->channels.empty());
    EXPECT_EQ(plain->x, bright->x);
}

TEST(ImageColour, LensDistortionIsThatOfMrpt) {
    auto o = pairOfCameras();
    o->cameraParamsIntensity.setDistortionPlumbBob(-0.2, 0.05, 0.01, -0.008, 0.01);
    const auto scan = observationToScan(*o);
    const std::size_t coloured = expectColours(*o, *scan, [&](const TPoint3D& p) {
        mrpt::img::TPixelCoordf pixel;
        mrpt::vision::pinhole::projectPoint_with_distortion(p, o->cameraParamsIntensity,
                                                            pixel);
        return pixel;
    });
    EXPECT_GT(coloured, 2000U);
}

TEST(ImageColour, FisheyeFollowsTheAngle) {
    auto o = pairOfCameras();
    o->cameraParamsIntensity.setDistortionKannalaBrandt(-0.1, 0.02, 0.003, -0.001);
    const auto scan = observationToScan(*o);
    const std::size_t coloured = expectColours(*o, *scan, [&](const TPoint3D& p) {
        const double flat = std::hypot(p.x, p.y), a = std::atan2(flat, p.z);
        const double bent = a - 0.1 * std::pow(a, 3) + 0.02 * std::pow(a, 5) +
                            0.003 * std::pow(a, 7) - 0.001 * std::pow(a, 9);
        return mrpt::img::TPixelCoordf(58.0 + 100.0 * bent * p.x / flat,
                                       47.0 + 103.0 * bent * p.y / flat);
    });
    EXPECT_GT(coloured, 2000U);
}

TEST(ImageColour, DistortionThatTurnsBackGivesNoColour) {
    auto o = pairOfCameras();
    // r (1 - r^2) is largest at r = .577: farther out, pixels would come back in.
    o->cameraParamsIntensity.setDistortionPlumbBob(-1.0, 0, 0, 0, 0);
    o->cameraParamsIntensity.fx(30);
    o->cameraParamsIntensity.fy(30);
    o->cameraParams.fx(25);
    o->cameraParams.fy(25);
    const auto scan = observationToScan(*o);
    const auto& r = channelOf(*scan, "r");
    std::size_t beyond = 0;
    for (std::size_t i = 0; i < scan->size(); ++i) {
        const TPoint3D p = inColourCamera(*o, *scan, i);
        const double tangent = std::hypot(p.x, p.y) / p.z;
        if (std::abs(tangent - 0.577) < 0.005) continue;
        EXPECT_EQ(std::isfinite(r[i]), tangent < 0.577) << tangent;
        beyond += tangent > 0.577 ? 1 : 0;
    }
    EXPECT_GT(beyond, 500U);
}

/// A wall at 2 m and a pole at 1 m before it, which the depth camera sees in columns 28 to
/// 35. The other camera, 10 cm to the left, sees a strip of the wall hidden by the pole
/// that the depth camera does see.
TEST(ImageColour, PointsBehindNearerOnesHaveNoColour) {
    auto o = pairOfCameras();
    for (int row = 0; row < 48; ++row)
        for (int col = 0; col < 64; ++col)
            o->rangeImage(row, col) = col >= 28 && col <= 35 ? 1000 : 2000;
    o->relativePoseIntensityWRTDepth =
        mrpt::poses::CPose3D(0, 0.1, 0, -M_PI / 2, 0, -M_PI / 2);
    const auto scan = observationToScan(*o);
    const auto& r = channelOf(*scan, "r");
    // The pole spans these y [m] at 1 m; from y = .1 its shadow on the wall spans 2 y - .1.
    const double left = (31.0 - 27.5) / 60, right = (31.0 - 35.5) / 60;
    const double edge_m = 4 * 2.0 / 100;  // four pixels of the image at 2 m
    std::size_t hidden = 0;
    for (std::size_t i = 0; i < scan->size(); ++i) {
        const TPoint3D p = inColourCamera(*o, *scan, i);
        if (!isInside(58 + 100 * p.x / p.z, 47 + 103 * p.y / p.z)) continue;
        const double y = scan->y[i];
        if (scan->x[i] < 1.5) {
            EXPECT_TRUE(std::isfinite(r[i])) << "of the pole";
        } else if (y > 2 * right - 0.1 + edge_m / 8 && y < 2 * left - 0.1 - edge_m / 8) {
            EXPECT_FALSE(std::isfinite(r[i])) << y;
            ++hidden;
        } else if (y < 2 * right - 0.1 - edge_m || y > 2 * left - 0.1 + edge_m) {
            EXPECT_TRUE(std::isfinite(r[i])) << y;
        }
    }
    EXPECT_GT(hidden, 48U);
}

TEST(ImageColour, UncalibratedOrWronglySizedImagesOfOtherCamerasAreNotUsed) {
    auto o = pairOfCameras();
    o->cameraParamsIntensity.ncols = 640;
    EXPECT_TRUE(observationToScan(*o)->channels.empty()) << "calibrated for another size";
    o = pairOfCameras();
    o->cameraParamsIntensity = TCamera();
    o->cameraParamsIntensity.ncols = kCols;
    o->cameraParamsIntensity.nrows = kRows;
    EXPECT_TRUE(observationToScan(*o)->channels.empty()) << "not calibrated";
    o = pairOfCameras();
    o->intensityImageChannel = mrpt::obs::CObservation3DRangeScan::CH_IR;
    EXPECT_TRUE(observationToScan(*o)->channels.empty()) << "infrared";
}

TEST(ImageColour, GreyImagesOfOtherCamerasAreIntensity) {
    auto o = pairOfCameras();
    const mrpt::img::CImage colour = o->intensityImage;
    o->intensityImage = mrpt::img::CImage(kCols, kRows, mrpt::img::CH_GRAY);
    for (int row = 0; row < kRows; ++row)
        for (int col = 0; col < kCols; ++col)
            o->intensityImage.at<uint8_t>(col, row) = static_cast<uint8_t>(2 * col);
    const auto scan = observationToScan(*o);
    ASSERT_EQ(scan->channels.size(), 1U);
    const auto& grey = channelOf(*scan, "intensity");
    o->intensityImage = colour;
    const auto coloured = observationToScan(*o);
    const auto& r = channelOf(*coloured, "r");
    for (std::size_t i = 0; i < scan->size(); ++i) {
        ASSERT_EQ(std::isfinite(grey[i]), std::isfinite(r[i]));
        if (!std::isfinite(r[i])) continue;
        EXPECT_EQ(grey[i], r[i]);
    }
}

/// Points without pixel numbers are projected, also if the cameras coincide.
TEST(ImageColour, PointsWithoutPixelNumbersAreProjected) {
    auto o = pairOfCameras();
    o->hasRangeImage = false;
    o->hasPoints3D = true;
    o->resizePoints3DVectors(2);
    o->points3D_idxs_x.clear();
    o->points3D_idxs_y.clear();
    o->points3D_x = {2.F, -1.F};
    o->points3D_y = {-0.5F, 0.1F};
    o->points3D_z = {0.2F, 0.1F};
    o->relativePoseIntensityWRTDepth =
        mrpt::poses::CPose3D(0, 0, 0, -M_PI / 2, 0, -M_PI / 2);
    const auto scan = observationToScan(*o);
    ASSERT_EQ(scan->size(), 2U);
    EXPECT_NEAR(channelOf(*scan, "r")[0] * 255 / 2, 58 + 100 * 0.25, 0.51);
    EXPECT_NEAR(channelOf(*scan, "g")[0] * 255 / 2, 47 - 103 * 0.1, 0.51);
    EXPECT_TRUE(std::isnan(channelOf(*scan, "r")[1])) << "behind the camera";
}

}  // namespace
