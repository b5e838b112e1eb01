#include "import_fixture.h"

using Eigen::Vector3d;
using import_test::DepthPixel;
using import_test::worldPoints;
using mrpt::obs::CObservation3DRangeScan;

namespace {

const hgmm::Pose kPoseA = import_test::makePose(1, -2, 0.5, 0.7, -0.3, 1.9);
const hgmm::Pose kPoseB = import_test::makePose(-3, 0.25, 1.5, -2.1, 0.4, -0.6);
const std::vector<DepthPixel> kPixels{{3, 5, 1500}, {20, 60, 4321}, {47, 0, 789}};

std::string matrixText(const hgmm::Pose& pose) {
    return import_test::kittiLine(pose) + "0 0 0 1\n";
}

/// The pinhole formula with the pose of the file.
Vector3d pinhole(const hgmm::Pose& T_world_optical, const DepthPixel& p, double f,
                 double cx, double cy, double unit) {
    const double z = p.value * unit;
    return import_test::transform(T_world_optical,
                                  {(p.col - cx) / f * z, (p.row - cy) / f * z, z});
}

class Import7Scenes : public import_test::ImportTest {
 protected:
    void writeFrame(const std::string& stem, const hgmm::Pose& pose) const {
        import_test::writeDepth(path(stem + ".depth.png"), kPixels);
        write(stem + ".pose.txt", matrixText(pose));
    }
};

}  // namespace

TEST_F(Import7Scenes, UnprojectedPointsAreThoseOfThePinholeFormula) {
    auto pixels = kPixels;
    pixels.push_back({10, 10, 65535});  // no depth
    import_test::writeDepth(path("in/frame-000000.depth.png"), pixels);
    write("in/frame-000000.pose.txt", matrixText(kPoseA));
    write("in/camera-intrinsics.txt", "60 0 31.5\n0 60 23.5\n0 0 1\n");
    importIt("7scenes in");

    const auto observations =
        import_test::readRawlog<CObservation3DRangeScan>(path("out.rawlog"));
    ASSERT_EQ(observations.size(), 1U);
    auto& o = *observations[0];
    EXPECT_TRUE(o.range_is_depth);
    EXPECT_FLOAT_EQ(o.rangeUnits, 0.001F);
    EXPECT_FALSE(o.hasIntensityImage);
    EXPECT_LT(import_test::poseDistance(poses()[0].T_world_frame, kPoseA), 1e-8);
    const auto points = worldPoints(o, poses()[0].T_world_frame);
    ASSERT_EQ(points.size(), kPixels.size());
    for (const auto& pixel : kPixels) {
        const Vector3d expected = pinhole(kPoseA, pixel, 60, 31.5, 23.5, 0.001);
        double nearest = INFINITY;
        for (const auto& point : points)
            nearest = std::min(nearest, (point - expected).norm());
        EXPECT_LT(nearest, 1e-4);
    }
}

TEST_F(Import7Scenes, OrdersFramesByNumberAndStampsThemAtThirtyHertz) {
    writeFrame("in/frame-11", kPoseB);
    writeFrame("in/frame-4", kPoseA);
    importIt("7scenes in");

    const auto trajectory = poses();
    expectStampsMatch(import_test::readRawlog<CObservation3DRangeScan>(path("out.rawlog")));
    ASSERT_EQ(trajectory.size(), 2U);
    EXPECT_NEAR(trajectory[0].stamp, 4 / 30.0, 1e-6);
    EXPECT_NEAR(trajectory[1].stamp, 11 / 30.0, 1e-6);
    EXPECT_LT(import_test::poseDistance(trajectory[0].T_world_frame, kPoseA), 1e-8);
    EXPECT_LT(import_test::poseDistance(trajectory[1].T_world_frame, kPoseB), 1e-8);
}

TEST_F(Import7Scenes, KeepsColourInTheRawlog) {
    writeFrame("in/frame-0", kPoseA);
    import_test::writeColor(path("in/frame-0.color.jpg"), 180);
    importIt("7scenes in");
    std::filesystem::remove_all(path("in"));

    const auto observations =
        import_test::readRawlog<CObservation3DRangeScan>(path("out.rawlog"));
    ASSERT_EQ(observations.size(), 1U);
    const auto& o = *observations[0];
    ASSERT_TRUE(o.hasIntensityImage);
    EXPECT_FALSE(o.intensityImage.isExternallyStored());
    EXPECT_FALSE(o.rangeImage_isExternallyStored());
    EXPECT_EQ(o.intensityImage.getWidth(), import_test::kCols);
    EXPECT_NEAR(o.intensityImage.at<std::uint8_t>(30, 20, 1), 180, 4);
    EXPECT_TRUE(o.doDepthAndIntensityCamerasCoincide());
    EXPECT_EQ(o.cameraParamsIntensity.fx(), o.cameraParams.fx());
}

TEST_F(Import7Scenes, IntrinsicsComeFromOptionThenFileThenDataset) {
    writeFrame("in/frame-0", kPoseA);
    const auto camera = [&] {
        const auto log =
            import_test::readRawlog<CObservation3DRangeScan>(path("out.rawlog"));
        const auto& c = log.at(0)->cameraParams;
        return std::vector<double>{c.fx(), c.fy(), c.cx(), c.cy()};
    };
    importIt("7scenes in");
    EXPECT_EQ(camera(), (std::vector<double>{585, 585, 320, 240}));
    write("in/camera-intrinsics.txt", "60 0 31\n0 61 23\n0 0 1\n");
    importIt("7scenes in");
    EXPECT_EQ(camera(), (std::vector<double>{60, 61, 31, 23}));
    importIt("7scenes in --intrinsics 1,2,3,4");
    EXPECT_EQ(camera(), (std::vector<double>{1, 2, 3, 4}));
}

TEST_F(Import7Scenes, StepTakesEveryNthFrame) {
    for (int i = 0; i < 5; ++i) writeFrame("in/frame-" + std::to_string(i), kPoseA);
    const auto result = importIt("7scenes in --step 2");
    EXPECT_NE(result.out.find("imported 3 scans"), std::string::npos) << result.out;
    ASSERT_EQ(poses().size(), 3U);
    EXPECT_NEAR(poses()[2].stamp, 4 / 30.0, 1e-6);
}

TEST_F(Import7Scenes, BadFramesAreNamed) {
    writeFrame("in/frame-0", kPoseA);
    const auto expectFailure = [&](const std::string& file, const std::string& what) {
        const auto result = run("7scenes in -o out.rawlog --poses-out out.tum");
        EXPECT_EQ(result.exitCode, 1);
        EXPECT_NE(result.err.find(file), std::string::npos) << result.err;
        EXPECT_NE(result.err.find(what), std::string::npos) << result.err;
        EXPECT_FALSE(std::filesystem::exists(path("out.rawlog")));
    };
    import_test::writeColor(path("in/frame-0.color.jpg"), 90, import_test::kCols / 2);
    expectFailure("frame-0.color.jpg", "differs in size");
    std::filesystem::remove(path("in/frame-0.color.jpg"));

    write("in/frame-0.pose.txt", "1 0 0 0\n0 1 0 0\n0 0 x 0\n0 0 0 1\n");
    expectFailure("frame-0.pose.txt", "'x' is not a finite number");
    write("in/frame-0.pose.txt", "1 0 0 0\n0 1 0 0\n0 0 3 0\n0 0 0 1\n");
    expectFailure("frame-0.pose.txt", "rotation");
    write("in/frame-0.pose.txt", "1 0 0 0\n");
    expectFailure("frame-0.pose.txt", "expected 16 numbers, got 4");
    std::filesystem::remove(path("in/frame-0.pose.txt"));
    expectFailure("frame-0.pose.txt", "missing");

    writeFrame("in/frame-0", kPoseA);
    const std::string png = import_test::readText(path("in/frame-0.depth.png"));
    write("in/frame-0.depth.png", png.substr(0, png.size() / 2));
    expectFailure("frame-0.depth.png", "no readable image");
    import_test::writeColor(path("in/frame-0.depth.png"), 90);
    expectFailure("frame-0.depth.png", "16 bit");
}

TEST_F(Import7Scenes, FramesWithoutAPoseAreSkippedAndDepthScaleIsTaken) {
    for (const char* name : {"in/frame-0", "in/frame-1", "in/frame-2"})
        writeFrame(name, kPoseA);
    writeFrame("in/frame-3", kPoseB);
    std::filesystem::remove(path("in/frame-1.pose.txt"));
    write("in/frame-2.pose.txt",
          "-inf -inf -inf -inf\n-inf -inf -inf -inf\n-inf -inf -inf -inf\n0 0 0 1\n");
    const auto result = importIt("7scenes in --depth-scale 2000");
    EXPECT_NE(result.out.find("2 without a pose"), std::string::npos) << result.out;
    const auto log = import_test::readRawlog<CObservation3DRangeScan>(path("out.rawlog"));
    ASSERT_EQ(log.size(), 2U);
    EXPECT_FLOAT_EQ(log[1]->rangeUnits, 0.0005F);
    EXPECT_LT(import_test::poseDistance(poses()[1].T_world_frame, kPoseB), 1e-8);
}
