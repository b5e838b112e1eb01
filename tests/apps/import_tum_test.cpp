#include "import_fixture.h"

using mrpt::obs::CObservation3DRangeScan;

namespace {

constexpr double kEpoch = 1305031102;

/// A camera that moves along x at 1 m/s: poses at 100 Hz over one second, images at 10 Hz.
class ImportTum : public import_test::ImportTest {
 protected:
    void writeSequence(const std::string& folder) const {
        std::string depths = "# depth maps\n", colors = "# color images\n",
                    poses = "# truth\n";
        for (int i = 0; i < 3; ++i) {
            const std::string number = std::to_string(i);
            const double depthStamp = kEpoch + 0.1 * i + 0.005;
            depths += stamped(depthStamp, "depth/" + number + ".png");
            colors +=
                stamped(depthStamp + (i == 1 ? 0.03 : 0.01), "rgb/" + number + ".png");
            import_test::writeDepth(path(folder + "/depth/" + number + ".png"),
                                    {{7, 9, static_cast<std::uint16_t>(5000 + i)}});
            import_test::writeColor(path(folder + "/rgb/" + number + ".png"), 100);
        }
        for (int i = 0; i < 100; ++i)
            poses += import_test::tumLine(kEpoch + 0.01 * i,
                                          import_test::makePose(0.01 * i, 0, 0, 0.3, 0, 0));
        write(folder + "/depth.txt", depths);
        write(folder + "/rgb.txt", colors);
        write(folder + "/groundtruth.txt", poses);
    }

    static std::string stamped(double stamp, const std::string& name) {
        char text[80];
        std::snprintf(text, sizeof text, "%.6f %s\n", stamp, name.c_str());
        return text;
    }
};

}  // namespace

TEST_F(ImportTum, InterpolatesPosesAndKeepsStamps) {
    writeSequence("rgbd_dataset_freiburg2_desk");
    importIt("tum rgbd_dataset_freiburg2_desk/");

    const auto log = import_test::readRawlog<CObservation3DRangeScan>(path("out.rawlog"));
    expectStampsMatch(log);
    const auto trajectory = poses();
    ASSERT_EQ(trajectory.size(), 3U);
    for (int i = 0; i < 3; ++i) {
        const auto& pose = trajectory[static_cast<std::size_t>(i)];
        EXPECT_NEAR(pose.stamp, kEpoch + 0.1 * i + 0.005, 2e-6);
        // 2e-6 s of resolution that a double has left at this epoch, at 1 m/s.
        EXPECT_NEAR(pose.T_world_frame.t.x(), 0.1 * i + 0.005, 4e-6);
    }
    EXPECT_FLOAT_EQ(log[1]->rangeUnits, 0.0002F);
    EXPECT_EQ(log[1]->rangeImage(7, 9), 5001);
    EXPECT_EQ(log[1]->cameraParams.fx(), 520.9);
    EXPECT_TRUE(log[0]->hasIntensityImage);
    EXPECT_FALSE(log[1]->hasIntensityImage) << "the nearest colour image is 30 ms away";
}

TEST_F(ImportTum, PointIsThatOfThePinholeFormula) {
    writeSequence("in");
    importIt("tum in --intrinsics 60,50,31,23");
    const auto log = import_test::readRawlog<CObservation3DRangeScan>(path("out.rawlog"));
    const hgmm::Pose pose = poses()[0].T_world_frame;
    const auto points = import_test::worldPoints(*log.at(0), pose);
    ASSERT_EQ(points.size(), 1U);
    const Eigen::Vector3d expected =
        import_test::transform(pose, {(9 - 31) / 60.0, (7 - 23) / 50.0, 1.0});
    EXPECT_LT((points[0] - expected).norm(), 1e-4);
}

TEST_F(ImportTum, LeavesOutImagesWithoutPoseAndSaysSo) {
    writeSequence("fr3");
    std::ofstream(path("fr3/depth.txt"), std::ios::app)
        << stamped(kEpoch + 5, "depth/0.png");
    const auto result = importIt("tum fr3");
    EXPECT_NE(result.out.find("imported 3 scans"), std::string::npos) << result.out;
    EXPECT_NE(result.err.find("3 of 4 depth images"), std::string::npos) << result.err;
}

TEST_F(ImportTum, SaysWhatIsMissing) {
    writeSequence("fr1");
    const auto expectFailure = [&](const std::string& folder, const std::string& what) {
        const auto result = run("tum " + folder + " -o out.rawlog --poses-out out.tum");
        EXPECT_EQ(result.exitCode, 1);
        EXPECT_NE(result.err.find(what), std::string::npos) << result.err;
    };
    writeSequence("desk");
    expectFailure("desk", "--intrinsics");
    write("fr1/depth.txt", "soon depth/0.png\n");
    expectFailure("fr1", "depth.txt: line 1: 'soon' is not a finite number");
    write("fr1/depth.txt", "900 depth/0.png\n");
    expectFailure("fr1", "0 of 1 depth images");
    write("fr1/depth.txt", stamped(kEpoch, "depth/gone.png"));
    expectFailure("fr1", "gone.png");
    std::filesystem::remove(path("fr1/depth.txt"));
    expectFailure("fr1", "depth.txt");
    expectFailure("nowhere_fr1", "nowhere_fr1");
}

TEST_F(ImportTum, DepthScaleIsTakenSaidAndDoubted) {
    writeSequence("fr1");
    const auto importScaled = [&](const std::string& options) {
        return run("tum fr1 -o out.rawlog --poses-out out.tum " + options);
    };
    const auto guessed = importScaled("");
    EXPECT_NE(guessed.out.find("5000 units a metre (the format's usual)"),
              std::string::npos)
        << guessed.out;
    EXPECT_TRUE(guessed.err.empty()) << guessed.err;
    const auto told = importScaled("--depth-scale 1000");
    EXPECT_NE(told.out.find("scale 1000 units a metre; median range 6"), std::string::npos)
        << told.out;
    const auto log = import_test::readRawlog<CObservation3DRangeScan>(path("out.rawlog"));
    EXPECT_FLOAT_EQ(log.at(0)->rangeUnits, 0.001F);
    // A guess is doubted at .2 m, and what no depth camera measures is refused.
    for (int i = 0; i < 3; ++i)
        import_test::writeDepth(path("fr1/depth/" + std::to_string(i) + ".png"),
                                {{24, 32, 1000}});
    const auto doubted = importScaled("");
    EXPECT_EQ(doubted.exitCode, 0);
    EXPECT_NE(doubted.err.find("--depth-scale"), std::string::npos) << doubted.err;
    EXPECT_TRUE(importScaled("--depth-scale 5000").err.empty());
    std::filesystem::remove(path("out.rawlog"));
    for (const char* scale : {"1", "10", "100000"}) {
        const auto refused = importScaled(std::string("--depth-scale ") + scale);
        EXPECT_EQ(refused.exitCode, 1) << scale;
        EXPECT_NE(refused.err.find("--depth-scale"), std::string::npos) << refused.err;
        EXPECT_FALSE(std::filesystem::exists(path("out.rawlog")));
    }
}

TEST_F(ImportTum, OneLostImageIsSkipped) {
    writeSequence("fr1");
    std::filesystem::remove(path("fr1/depth/1.png"));
    const auto result = importIt("tum fr1");
    EXPECT_NE(result.out.find("skipped 1 scans (1 unreadable"), std::string::npos)
        << result.out;
    const auto log = import_test::readRawlog<CObservation3DRangeScan>(path("out.rawlog"));
    expectStampsMatch(log);
    ASSERT_EQ(log.size(), 2U);
    EXPECT_EQ(log[1]->rangeImage(7, 9), 5002);
    EXPECT_NEAR(poses()[1].T_world_frame.t.x(), 0.205, 4e-6);
}
