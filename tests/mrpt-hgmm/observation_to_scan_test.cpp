#include "hgmm/mrpt_bridge/observation_to_scan.h"

#include <gtest/gtest.h>
#include <mrpt/obs/CObservationOdometry.h>
#include <mrpt/obs/VelodyneCalibration.h>

#include <filesystem>
#include <limits>

#include "observations.h"

using hgmm::Scan;
using hgmm::mrpt_bridge::isSupported;
using hgmm::mrpt_bridge::observationToScan;
using mrpt::poses::CPose3D;

namespace {

constexpr float kNan = std::numeric_limits<float>::quiet_NaN();

void expectPoint(const Scan& scan, std::size_t i, double x, double y, double z,
                 double tolerance = 1e-5) {
    ASSERT_LT(i, scan.size());
    EXPECT_NEAR(scan.x[i], x, tolerance) << "point " << i;
    EXPECT_NEAR(scan.y[i], y, tolerance) << "point " << i;
    EXPECT_NEAR(scan.z[i], z, tolerance) << "point " << i;
}

const std::vector<float>* channel(const Scan& scan, const std::string& name) {
    for (const auto& c : scan.channels)
        if (c.name == name) return &c.values;
    return nullptr;
}

TEST(ObservationToScan, ComposesRobotAndSensorPoseInDouble) {
    const CPose3D robot(1e6 + 0.001, -2e6, 3, 0.7, 0.2, -0.1),
        sensor(0.3, 0.1, 1, -0.4, 0.1, 0.2);
    for (const auto& [name, o] : observations::all()) {
        ASSERT_TRUE(o) << name;
        o->setSensorPose(sensor);
        const auto scan = observationToScan(*o, robot);
        ASSERT_TRUE(scan) << name;
        EXPECT_GT(scan->size(), 100U) << name;
        EXPECT_NO_THROW(scan->validate());
        const CPose3D expected = robot + sensor;
        EXPECT_NEAR(scan->T_map_sensor.t.x(), expected.x(), 1e-8) << name;
        EXPECT_NEAR(scan->T_map_sensor.t.y(), expected.y(), 1e-8) << name;
        for (int r = 0; r < 3; ++r)
            for (int c = 0; c < 3; ++c)
                EXPECT_NEAR(scan->T_map_sensor.R(r, c), expected.getRotationMatrix()(r, c),
                            1e-12);
        // The points themselves know nothing of either pose.
        o->setSensorPose(CPose3D());
        const auto plain = observationToScan(*o);
        EXPECT_EQ(plain->x, scan->x) << name;
        EXPECT_EQ(plain->T_map_sensor.t, Eigen::Vector3d::Zero());
    }
}

TEST(ObservationToScan, PoseConversionsAreInverse) {
    const CPose3D pose(1, 2, 3, 0.4, -0.5, 0.6);
    const CPose3D back = hgmm::mrpt_bridge::toCPose3D(hgmm::mrpt_bridge::toPose(pose));
    for (int i = 0; i < 6; ++i) EXPECT_NEAR(back[i], pose[i], 1e-12);
}

TEST(ObservationToScan, UnsupportedTypeIsNothing) {
    const mrpt::obs::CObservationOdometry odometry;
    EXPECT_FALSE(observationToScan(odometry));
    EXPECT_FALSE(isSupported(odometry));
    EXPECT_TRUE(isSupported(*observations::laser()));
}

TEST(ObservationToScan, EmptyObservationsAreEmptyScans) {
    for (const mrpt::obs::CObservation::Ptr& o : std::vector<mrpt::obs::CObservation::Ptr>{
             mrpt::obs::CObservation2DRangeScan::Create(),
             mrpt::obs::CObservation3DRangeScan::Create(),
             mrpt::obs::CObservationPointCloud::Create(),
             mrpt::obs::CObservationVelodyneScan::Create(),
             mrpt::obs::CObservationRotatingScan::Create()}) {
        const auto scan = observationToScan(*o);
        ASSERT_TRUE(scan) << o->GetRuntimeClass()->className;
        EXPECT_EQ(scan->size(), 0U);
    }
}

TEST(ObservationToScan, LaserKeepsValidRaysOnly) {
    auto o = observations::laser(5);  // at -90, -45, 0, 45, 90 deg
    o->setScanRange(0, 2.F);
    o->setScanRange(4, 3.F);
    o->setScanRangeValidity(1, false);
    o->setScanRange(2, kNan);
    o->setScanRange(3, 0.F);
    const auto scan = observationToScan(*o);
    ASSERT_EQ(scan->size(), 2U);
    expectPoint(*scan, 0, 0, -2, 0);
    expectPoint(*scan, 1, 0, 3, 0);

    o->rightToLeft = false;
    expectPoint(*observationToScan(*o), 0, 0, 2, 0);
}

TEST(ObservationToScan, LaserTurnsDownwardsWithDeltaPitch) {
    auto o = observations::laser(3);
    o->aperture = 0.F;  // all rays forward: the sweep alone moves them
    for (std::size_t i = 0; i < 3; ++i) o->setScanRange(i, 2.F);
    o->deltaPitch = M_PI / 2;
    const auto scan = observationToScan(*o);
    expectPoint(*scan, 0, 2, 0, 0);
    expectPoint(*scan, 1, std::sqrt(2.0), 0, -std::sqrt(2.0));
    expectPoint(*scan, 2, 0, 0, -2);
}

TEST(ObservationToScan, DepthImageFollowsThePinholeModel) {
    auto o = observations::depthImage();
    o->rangeImage(7, 11) = 0;
    const auto scan = observationToScan(*o);
    EXPECT_EQ(scan->size(), 48U * 64U - 1U);
    const double x = o->rangeImage(40, 50) * 0.001;
    expectPoint(*scan, 40 * 64 + 50 - 1, x, (31.0 - 50) * x / 60.0, (25.0 - 40) * x / 62.0);
    EXPECT_TRUE(scan->channels.empty());

    o->range_is_depth = false;
    const auto ranged = observationToScan(*o);
    const std::size_t i = 40 * 64 + 50 - 1;
    EXPECT_NEAR(std::hypot(ranged->x[i], ranged->y[i], ranged->z[i]), x, 1e-5);
    EXPECT_NEAR(ranged->y[i] / ranged->x[i], scan->y[i] / scan->x[i], 1e-5);
}

TEST(ObservationToScan, DepthImageAgreesWithMrptAlsoUnderDistortion) {
    auto o = observations::depthImage();
    for (const double k1 : {0.0, -0.08}) {
        o->cameraParams.setDistortionPlumbBob(k1, 0.01, 0, 0, 0);
        for (const bool isDepth : {true, false}) {
            o->range_is_depth = isDepth;
            mrpt::maps::CSimplePointsMap expected;
            mrpt::obs::CObservation3DRangeScan copy = *o;
            copy.unprojectInto(expected);
            const auto scan = observationToScan(*o);
            ASSERT_EQ(scan->size(), expected.size());
            for (std::size_t i = 0; i < scan->size(); i += 97) {
                float x = 0, y = 0, z = 0;
                expected.getPoint(i, x, y, z);
                expectPoint(*scan, i, x, y, z, 1e-3);
            }
        }
    }
}

TEST(ObservationToScan, Points3DAreTakenWithoutInvalidOnes) {
    auto o = observations::depthImage();
    o->hasPoints3D = true;
    o->resizePoints3DVectors(4);
    o->points3D_x = {1, 0, kNan, 4};
    o->points3D_y = {2, 0, 1, 5};
    o->points3D_z = {3, 0, 1, std::numeric_limits<float>::infinity()};
    const auto scan = observationToScan(*o);
    ASSERT_EQ(scan->size(), 1U);
    expectPoint(*scan, 0, 1, 2, 3);
}

TEST(ObservationToScan, UncalibratedDepthImageIsRefused) {
    auto o = observations::depthImage();
    o->cameraParams = mrpt::img::TCamera();
    EXPECT_FALSE(observationToScan(*o));
}

TEST(ObservationToScan, AlignedImageColoursThePoints) {
    auto o = observations::depthImage();
    o->hasIntensityImage = true;
    o->intensityImage.resize(64, 48, mrpt::img::CH_RGB);
    o->intensityImage.filledRectangle(0, 0, 63, 47, mrpt::img::TColor(0, 0, 0));
    o->intensityImage.setPixel(50, 40, 0xFF8000);  // red 255, green 128, blue 0
    o->rangeImage(0, 0) = 0;
    const std::size_t i = 40 * 64 + 50 - 1;
    const auto scan = observationToScan(*o);
    for (const auto& [name, value] :
         {std::pair{"r", 1.0}, std::pair{"g", 128 / 255.0}, std::pair{"b", 0.0}}) {
        ASSERT_TRUE(channel(*scan, name)) << name;
        ASSERT_EQ(channel(*scan, name)->size(), scan->size());
        EXPECT_NEAR((*channel(*scan, name))[i], value, 1e-6) << name;
    }

    o->relativePoseIntensityWRTDepth.x(0.05);
    EXPECT_TRUE(observationToScan(*o)->channels.empty()) << "the cameras are apart";
    o->relativePoseIntensityWRTDepth.x(0);
    o->cameraParamsIntensity = o->cameraParams;
    o->cameraParamsIntensity.fx(80);
    // 19 columns right of the centre at fx = 60 are 25 at 80; around it is black.
    EXPECT_EQ((*channel(*observationToScan(*o), "r"))[i], 0.F) << "the lenses differ";
    o->cameraParamsIntensity = o->cameraParams;
    o->intensityImage.resize(32, 24, mrpt::img::CH_RGB);
    EXPECT_TRUE(observationToScan(*o)->channels.empty()) << "the sizes differ";
}

TEST(ObservationToScan, GreyImageIsIntensity) {
    auto o = observations::depthImage();
    o->hasIntensityImage = true;
    o->intensityImage.resize(64, 48, mrpt::img::CH_GRAY);
    o->intensityImage.filledRectangle(0, 0, 63, 47, mrpt::img::TColor(51, 51, 51));
    const auto scan = observationToScan(*o);
    ASSERT_TRUE(channel(*scan, "intensity"));
    EXPECT_NEAR(channel(*scan, "intensity")->at(5), 0.2, 1e-6);
}

TEST(ObservationToScan, ExternallyStoredPointsAreLoadedAndUnloadedAgain) {
    const auto folder = std::filesystem::path(::testing::TempDir());
    auto o = observations::depthImage();
    o->hasRangeImage = false;
    o->hasPoints3D = true;
    o->resizePoints3DVectors(2);
    o->points3D_x = {1, 2};
    o->points3D_y = {3, 4};
    o->points3D_z = {5, 6};
    mrpt::img::CImage::setImagesPathBase(folder.string());
    o->points3D_convertToExternalStorage("hgmm_points.bin", folder.string());
    o->unload();
    ASSERT_TRUE(o->points3D_x.empty());
    const auto scan = observationToScan(*o);
    ASSERT_EQ(scan->size(), 2U);
    expectPoint(*scan, 1, 2, 4, 6);
    EXPECT_TRUE(o->points3D_x.empty()) << "what was outside is outside again";
    std::filesystem::remove(folder / "hgmm_points.bin");
}

TEST(ObservationToScan, CloudsBringTheirChannels) {
    auto o = observations::cloud();
    o->pointcloud->insertPoint(kNan, 0, 0);
    EXPECT_EQ(observationToScan(*o)->size(), 600U);
    EXPECT_TRUE(observationToScan(*o)->channels.empty());

    auto xyzi = mrpt::maps::CPointsMapXYZI::Create();
    xyzi->insertPointRGB(kNan, 1, 1, 0.1F, 0, 0);
    xyzi->insertPointRGB(1, 2, 3, 0.7F, 0, 0);
    o->pointcloud = xyzi;
    const auto grey = observationToScan(*o);
    ASSERT_EQ(grey->size(), 1U);
    ASSERT_TRUE(channel(*grey, "intensity"));
    EXPECT_FLOAT_EQ(channel(*grey, "intensity")->at(0), 0.7F);
    for (const auto& [raw, scaled] :
         {std::pair{51.F, 0.2F}, std::pair{13107.F, 0.2F}, std::pair{-1.F, 0.F}}) {
        auto counts = mrpt::maps::CPointsMapXYZI::Create();
        counts->insertPointRGB(1, 2, 3, raw, 0, 0);
        o->pointcloud = counts;
        EXPECT_FLOAT_EQ(channel(*observationToScan(*o), "intensity")->at(0), scaled) << raw;
    }
    xyzi->insertPointRGB(1, 2, 3, kNan, 0, 0);
    o->pointcloud = xyzi;
    EXPECT_TRUE(std::isnan(channel(*observationToScan(*o), "intensity")->at(1)));

    auto coloured = mrpt::maps::CColouredPointsMap::Create();
    coloured->insertPointRGB(1, 2, 3, 0.1F, 0.2F, 0.3F);
    o->pointcloud = coloured;
    const auto rgb = observationToScan(*o);
    ASSERT_TRUE(channel(*rgb, "r") && channel(*rgb, "g") && channel(*rgb, "b"));
    EXPECT_FLOAT_EQ(channel(*rgb, "b")->at(0), 0.3F);
}

TEST(ObservationToScan, VelodynePacketsGiveTheCloudWithoutTouchingTheObservation) {
    const auto o = observations::velodyne();
    ASSERT_TRUE(o);
    const auto scan = observationToScan(*o);
    EXPECT_EQ(o->point_cloud.size(), 0U);
    EXPECT_EQ(scan->size(), 11305U);
    ASSERT_TRUE(channel(*scan, "intensity"));
    EXPECT_LE(*std::max_element(channel(*scan, "intensity")->begin(),
                                channel(*scan, "intensity")->end()),
              1.F);
    o->generatePointCloud();
    const auto again = observationToScan(*o);
    ASSERT_EQ(again->size(), o->point_cloud.size());
    EXPECT_EQ(again->x.front(), o->point_cloud.x.front());
    for (std::size_t i = 0; i < again->size(); i += 111)
        EXPECT_FLOAT_EQ(channel(*again, "intensity")->at(i),
                        o->point_cloud.intensity[i] / 255.F);
    o->point_cloud.intensity.clear();
    EXPECT_TRUE(observationToScan(*o)->channels.empty()) << "not measured is not dark";

    mrpt::obs::CObservationVelodyneScan bare = *o;
    bare.point_cloud.clear();
    bare.calibration.clear();
    EXPECT_FALSE(observationToScan(bare));
    EXPECT_FALSE(isSupported(bare));
}

// The recorded rotating scan and the Velodyne packets are the same revolution: point by
// point they must agree in direction, which a wrong sign, row order or column count would
// spoil.
TEST(ObservationToScan, RotatingScanTurnsLikeTheVelodyneItCameFrom) {
    const auto packets = observations::velodyne();
    mrpt::obs::CObservationRotatingScan converted;
    converted.fromVelodyne(*packets);
    const auto expected = observationToScan(*packets);
    for (const auto& scan : {observationToScan(*observations::recordedRotating()),
                             observationToScan(converted)}) {
        ASSERT_TRUE(scan);
        ASSERT_EQ(scan->size(), expected->size());
        double worst = 0;
        for (std::size_t i = 0; i < scan->size(); ++i) {
            const Eigen::Vector3d p(scan->x[i], scan->y[i], scan->z[i]);
            const Eigen::Vector3d q(expected->x[i], expected->y[i], expected->z[i]);
            ASSERT_NEAR(p.norm(), q.norm(), 0.002) << i;
            ASSERT_FLOAT_EQ(channel(*scan, "intensity")->at(i),
                            channel(*expected, "intensity")->at(i));
            worst = std::max(worst,
                             std::acos(std::min(1.0, p.normalized().dot(q.normalized()))));
        }
        // Within a column the lasers fire one after the other, over about 0.2 deg.
        EXPECT_LT(worst, mrpt::DEG2RAD(0.3));
    }
}

TEST(ObservationToScan, RotatingScanOfOneRowIsTheLaserScanItCameFrom) {
    const auto laser = observations::laser();
    for (const bool rightToLeft : {true, false}) {
        laser->rightToLeft = rightToLeft;
        mrpt::obs::CObservationRotatingScan o;
        o.fromScan2D(*laser);
        const auto scan = observationToScan(o), expected = observationToScan(*laser);
        ASSERT_TRUE(scan);
        ASSERT_EQ(scan->size(), expected->size());
        for (std::size_t i = 0; i < scan->size(); i += 20)
            expectPoint(*scan, i, expected->x[i], expected->y[i], expected->z[i], 0.01);
    }
}

TEST(ObservationToScan, DocumentedRotatingScanIsCounterClockwiseWithModelElevations) {
    auto o = observations::rotating(32, 3);  // -90, 0, 90 deg
    o->rangeImage.fill(1000);                // 2 m
    const auto scan = observationToScan(*o);
    ASSERT_EQ(scan->size(), 96U);
    const double elevation =
        mrpt::DEG2RAD(mrpt::obs::VelodyneCalibration::LoadDefaultCalibration("HDL32")
                          .laser_corrections[1]
                          .verticalCorrection);
    expectPoint(*scan, 1, 0, -2 * std::cos(elevation), 2 * std::sin(elevation));
    expectPoint(*scan, 32 + 1, 2 * std::cos(elevation), 0, 2 * std::sin(elevation));
}

TEST(ObservationToScan, UnknownElevationsAreRefusedOnceWithAMessage) {
    auto o = observations::rotating(64);
    o->sensorLabel = "refused";
    ::testing::internal::CaptureStderr();
    EXPECT_FALSE(observationToScan(*o));
    EXPECT_FALSE(observationToScan(*o));
    const std::string said = ::testing::internal::GetCapturedStderr();
    EXPECT_NE(said.find("64 rows"), std::string::npos) << said;
    EXPECT_EQ(said.find("64 rows"), said.rfind("64 rows")) << said;
    EXPECT_FALSE(isSupported(*o));

    auto other = observations::rotating(32);
    other->lidarModel = "VLP-32C";  // 32 rows, other elevations
    EXPECT_FALSE(observationToScan(*other));
}

}  // namespace
