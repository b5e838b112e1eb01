#include <mrpt/maps/CPointsMapXYZI.h>

#include "import_fixture.h"

using mrpt::maps::CPointsMapXYZI;
using mrpt::obs::CObservationPointCloud;

namespace {

const hgmm::Pose kCameraFromVelodyne =
    import_test::makePose(0.1, -0.08, -0.27, -M_PI / 2, 0.01, -M_PI / 2);

class ImportKitti : public import_test::ImportTest {
 protected:
    void writeSequence(const std::vector<std::string>& scans, int poseCount) const {
        write("in/calib.txt", "P0: 1 0 0 0 0 1 0 0 0 0 1 0\nTr: " +
                                  import_test::kittiLine(kCameraFromVelodyne));
        for (const auto& name : scans)
            write(
                "in/velodyne/" + name + ".bin",
                import_test::bytesOf<float>({1, 2, 3, 0.25F, 0, 0, 0, 0, -4, 5, 6, 0.75F}));
        writeLines(poseCount);
    }
    void writeLines(int poseCount) const {
        std::string poseLines;
        for (int i = 0; i < poseCount; ++i)
            poseLines += import_test::kittiLine(cameraPose(i));
        write("poses.txt", poseLines);
    }
    static hgmm::Pose cameraPose(int i) {
        return import_test::makePose(i, 2, 3, 0.1 * i, 0, 0.2);
    }
};

}  // namespace

TEST_F(ImportKitti, ComposesPoseAndCalibration) {
    writeSequence({"000000", "000001"}, 2);
    const auto result = importIt("kitti in --poses poses.txt");
    EXPECT_NE(result.out.find("2 points without a return"), std::string::npos)
        << result.out;

    const auto log = import_test::readRawlog<CObservationPointCloud>(path("out.rawlog"));
    expectStampsMatch(log);
    ASSERT_EQ(log.size(), 2U);
    const auto trajectory = poses();
    EXPECT_NEAR(trajectory[1].stamp - trajectory[0].stamp, 0.1, 1e-6);
    const auto points = import_test::worldPoints(*log[1], trajectory[1].T_world_frame);
    ASSERT_EQ(points.size(), 2U);
    for (const auto& [index, p_velodyne] :
         {std::pair<std::size_t, Eigen::Vector3d>{0, {1, 2, 3}}, {1, {-4, 5, 6}}}) {
        const auto p_camera = import_test::transform(kCameraFromVelodyne, p_velodyne);
        EXPECT_LT((points[index] - import_test::transform(cameraPose(1), p_camera)).norm(),
                  1e-5);
    }
    const auto cloud = std::dynamic_pointer_cast<CPointsMapXYZI>(log[1]->pointcloud);
    ASSERT_TRUE(cloud);
    EXPECT_EQ(cloud->getPointIntensity(1), 0.75F);
}

TEST_F(ImportKitti, PartOfASequenceTakesPosesAndTimesByNumber) {
    writeSequence({"000002", "000004"}, 6);
    write("in/times.txt", "0 0.5 1.5 2 2.5 3.25\n");
    const auto result = importIt("kitti in --poses poses.txt");
    EXPECT_NE(result.err.find("6 poses for the 2 .bin files"), std::string::npos)
        << result.err;
    const auto trajectory = poses();
    ASSERT_EQ(trajectory.size(), 2U);
    EXPECT_NEAR(trajectory[0].stamp, 1.5, 1e-6);
    EXPECT_NEAR(trajectory[1].stamp, 2.5, 1e-6);
    EXPECT_LT(import_test::poseDistance(trajectory[1].T_world_frame,
                                        cameraPose(4) * kCameraFromVelodyne),
              1e-8);
}

TEST_F(ImportKitti, SaysWhatIsWrong) {
    const auto expectFailure = [&](const std::string& what) {
        const auto result =
            run("kitti in --poses poses.txt -o out.rawlog --poses-out out.tum");
        EXPECT_EQ(result.exitCode, 1);
        EXPECT_NE(result.err.find(what), std::string::npos) << result.err;
    };
    writeSequence({"000000", "000001", "000002"}, 2);
    expectFailure("only 2 poses for the 3 .bin files");
    writeSequence({"000000", "000001", "000002"}, 3);
    write("in/times.txt", "0 1\n");
    expectFailure("times.txt: has only 2 times");
    std::filesystem::remove(path("in/times.txt"));
    for (const char* name : {"000000", "000001", "000002"})
        write(std::string("in/velodyne/") + name + ".bin", std::string(30, 'x'));
    writeLines(3);
    expectFailure("000000.bin: is truncated");
    write("in/calib.txt", "P0: 1 2 3\n");
    expectFailure("calib.txt: has no line 'Tr:'");
    write("in/calib.txt", "Tr: 1 2 3\n");
    expectFailure("3 numbers, not 12");
}
