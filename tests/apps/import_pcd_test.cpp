#include <mrpt/maps/CColouredPointsMap.h>
#include <mrpt/maps/CPointsMapXYZI.h>

#include "import_fixture.h"
#include "pcd_files.h"

using Eigen::Vector3d;
using import_test::append;
using import_test::asciiPcd;
using import_test::pcdHeader;
using mrpt::obs::CObservationPointCloud;
using Points = std::vector<Vector3d>;

namespace {

const hgmm::Pose kPose = import_test::makePose(10, -5, 2, 0.8, -0.2, 0.1);

class ImportPcd : public import_test::ImportTest {
 protected:
    /// Imports one file at the identity pose.
    CObservationPointCloud::Ptr importOne(const std::string& content) const {
        write("in/1.pcd", content);
        write("poses.txt", import_test::tumLine(3.5, {}));
        importIt("pcd in --poses poses.txt");
        const auto log =
            import_test::readRawlog<CObservationPointCloud>(path("out.rawlog"));
        return log.empty() ? nullptr : log[0];
    }
    static void expectPoints(const CObservationPointCloud& o,
                             const hgmm::Pose& T_world_robot, const Points& expected,
                             double tolerance = 1e-6) {
        const auto points = import_test::worldPoints(o, T_world_robot);
        ASSERT_EQ(points.size(), expected.size());
        for (std::size_t i = 0; i < points.size(); ++i)
            EXPECT_LT((points[i] - expected[i]).norm(), tolerance) << "point " << i;
    }
    void expectFailure(const std::string& content, const std::string& what) const {
        write("in/1.pcd", content);
        write("poses.txt", import_test::tumLine(3.5, {}));
        const auto result =
            run("pcd in --poses poses.txt -o out.rawlog --poses-out out.tum");
        EXPECT_EQ(result.exitCode, 1);
        EXPECT_NE(result.err.find("1.pcd"), std::string::npos) << result.err;
        EXPECT_NE(result.err.find(what), std::string::npos) << result.err;
        for (const auto& entry : std::filesystem::directory_iterator(path("")))
            EXPECT_NE(entry.path().filename().string().rfind("out.", 0), 0U) << entry;
    }
};

std::string binaryRow(float x, float y, float z) {
    std::string bytes;
    for (const float v : {x, y, z}) append(bytes, v);
    return bytes;
}

}  // namespace

TEST_F(ImportPcd, ReadsAscii) {
    const auto o = importOne(asciiPcd(2, "1 2.5 -3\n4e-1\t5 6\r\n"));
    ASSERT_TRUE(o);
    expectPoints(*o, {}, {{1, 2.5, -3}, {0.4, 5, 6}});
    EXPECT_NEAR(mrpt::Clock::toDouble(o->timestamp), 3.5, 1e-6);
}

TEST_F(ImportPcd, ReadsBinaryFieldsOfAnyOrderSizeAndType) {
    std::string content = pcdHeader("z junk intensity y x", "8 2 2 4 4", "F I U F F",
                                    "1 3 1 1 1", 2, "binary");
    for (const double offset : {0.0, 10.0}) {
        append(content, 3.0 + offset);
        for (int i = 0; i < 3; ++i) append(content, std::int16_t{-9});
        append(content, static_cast<std::uint16_t>(65000 + offset));
        append(content, static_cast<float>(2 + offset));
        append(content, static_cast<float>(1 + offset));
    }
    const auto o = importOne(content + std::string(5000, '\0'));
    ASSERT_TRUE(o);
    expectPoints(*o, {}, {{1, 2, 3}, {11, 12, 13}});
    const auto cloud = std::dynamic_pointer_cast<mrpt::maps::CPointsMapXYZI>(o->pointcloud);
    ASSERT_TRUE(cloud);
    EXPECT_FLOAT_EQ(cloud->getPointIntensity(1), 65010.F / 65535);
}

TEST_F(ImportPcd, ReadsCompressedWithRepetitions) {
    // Field by field: x = 1 1 1 1 (a repetition that overlaps itself), y = 2 3 4 5, z like
    // y.
    std::string x, y;
    append(x, 1.F);
    for (const float v : {2.F, 3.F, 4.F, 5.F}) append(y, v);
    const std::string block =
        import_test::lzfLiteral(x) + import_test::lzfRepetition(12, 4) +
        import_test::lzfLiteral(y) + import_test::lzfRepetition(16, 16);
    const auto header =
        pcdHeader("x y z", "4 4 4", "F F F", "1 1 1", 4, "binary_compressed");
    const auto o = importOne(header + import_test::compressedData(block, 48));
    ASSERT_TRUE(o);
    expectPoints(*o, {}, {{1, 2, 2}, {1, 3, 3}, {1, 4, 4}, {1, 5, 5}});
}

TEST_F(ImportPcd, RefusesDamagedCompression) {
    const auto header =
        pcdHeader("x y z", "4 4 4", "F F F", "1 1 1", 4, "binary_compressed");
    const std::string row = binaryRow(1, 2, 3);
    const std::string whole =
        import_test::lzfLiteral(row) + import_test::lzfRepetition(36, 12);
    expectFailure(header + import_test::compressedData(whole, 36), "another size");
    expectFailure(header + import_test::compressedData(whole, 48).substr(0, 20),
                  "is truncated");
    expectFailure(header + import_test::compressedData(whole.substr(0, 13), 48),
                  "does not unpack");
    expectFailure(
        header + import_test::compressedData(
                     import_test::lzfLiteral(row) + import_test::lzfRepetition(36, 13), 48),
        "damaged");
    expectFailure(header + import_test::compressedData(whole.substr(0, 5), 48),
                  "ends too early");
}

TEST_F(ImportPcd, ReadsColours) {
    std::string binary =
        pcdHeader("x y z rgb", "4 4 4 4", "F F F F", "1 1 1 1", 1, "binary");
    binary += binaryRow(1, 2, 3);
    append(binary, std::uint32_t{0x00FF8040});
    const std::string ascii =
        pcdHeader("x y z rgba", "4 4 4 4", "F F F U", "1 1 1 1", 1, "ascii") +
        "1 2 3 4294934592\n";
    for (const auto& content : {binary, ascii}) {
        const auto o = importOne(content);
        ASSERT_TRUE(o);
        const auto cloud =
            std::dynamic_pointer_cast<mrpt::maps::CColouredPointsMap>(o->pointcloud);
        ASSERT_TRUE(cloud);
        float x = 0, y = 0, z = 0, r = 0, g = 0, b = 0;
        cloud->getPointRGB(0, x, y, z, r, g, b);
        EXPECT_NEAR(r, 1, 0.003);
        EXPECT_NEAR(g, 128 / 255.0, 0.003);
        EXPECT_NEAR(b, 64 / 255.0, 0.003);
    }
}

TEST_F(ImportPcd, LeavesOutPointsWithoutReturn) {
    write("in/1.pcd", asciiPcd(4, "1 0 0\n0 0 0\nnan nan nan\n0 0 2\n"));
    write("poses.txt", import_test::tumLine(0, kPose));
    const auto result = importIt("pcd in --poses poses.txt --sensor-pose 1,0,0,0,0,0");
    EXPECT_NE(result.out.find("left out 2 points"), std::string::npos) << result.out;
    const auto log = import_test::readRawlog<CObservationPointCloud>(path("out.rawlog"));
    ASSERT_EQ(log.size(), 1U);
    // The point at the sensor itself was measured in the given frame; it stays.
    expectPoints(*log[0], {}, {{1, 0, 0}, {0, 0, 2}});
}

TEST_F(ImportPcd, SensorPoseMovesTheRayOriginNotThePoints) {
    write("in/1.pcd", asciiPcd(2, "1 2 3\n-4 5 6\n"));
    write("poses.txt", import_test::tumLine(7, kPose));
    importIt("pcd in --poses poses.txt --sensor-pose -0.5,0.25,1,90,-20,10");
    const auto log = import_test::readRawlog<CObservationPointCloud>(path("out.rawlog"));
    ASSERT_EQ(log.size(), 1U);
    const auto T_frame_sensor =
        import_test::makePose(-0.5, 0.25, 1, M_PI / 2, -M_PI / 9, M_PI / 18);
    EXPECT_LT(
        import_test::poseDistance(import_test::toPose(log[0]->sensorPose), T_frame_sensor),
        1e-12);
    const auto robot = poses()[0].T_world_frame;
    EXPECT_LT(import_test::poseDistance(robot, kPose), 1e-8);
    expectPoints(*log[0], robot,
                 {import_test::transform(kPose, {1, 2, 3}),
                  import_test::transform(kPose, {-4, 5, 6})},
                 1e-5);
    float x = 0, y = 0, z = 0;
    log[0]->pointcloud->getPointFast(0, x, y, z);
    const Vector3d p_sensor = import_test::transform(T_frame_sensor.inverse(), {1, 2, 3});
    EXPECT_LT((Vector3d(x, y, z) - p_sensor).norm(), 1e-6);
}

TEST_F(ImportPcd, WorldFrameTakesTheRayOriginFromViewpoint) {
    write("in/room_1.pcd", asciiPcd(1, "11 20 30\n", "10 20 30.5"));
    write("in/room_2.pcd", asciiPcd(1, "-1 -2 -3\n", "0 0 1"));
    importIt("pcd in --world-frame");
    const auto log = import_test::readRawlog<CObservationPointCloud>(path("out.rawlog"));
    expectStampsMatch(log);
    const auto trajectory = poses();
    ASSERT_EQ(trajectory.size(), 2U);
    EXPECT_LT((trajectory[0].T_world_frame.t - Vector3d(10, 20, 30.5)).norm(), 1e-9);
    EXPECT_TRUE(trajectory[0].T_world_frame.R.isIdentity(1e-12));
    EXPECT_EQ(log[0]->sensorPose, mrpt::poses::CPose3D());
    expectPoints(*log[0], trajectory[0].T_world_frame, {{11, 20, 30}});
    expectPoints(*log[1], trajectory[1].T_world_frame, {{-1, -2, -3}});
    EXPECT_NEAR(trajectory[1].stamp - trajectory[0].stamp, 0.1, 1e-6);
}

TEST_F(ImportPcd, KittiPosesAreStampedATenthOfASecondApart) {
    write("poses.txt", import_test::kittiLine(kPose) + import_test::kittiLine(kPose));
    for (const char* name : {"in/0.pcd", "in/1.pcd"}) write(name, asciiPcd(1, "1 2 3\n"));
    importIt("pcd in --poses poses.txt");
    expectStampsMatch(import_test::readRawlog<CObservationPointCloud>(path("out.rawlog")));
    EXPECT_NEAR(poses()[1].stamp, 0.1, 1e-6);
    EXPECT_LT(import_test::poseDistance(poses()[1].T_world_frame, kPose), 1e-8);
}

TEST_F(ImportPcd, BadFilesAreNamed) {
    const std::string header = pcdHeader("x y z", "4 4 4", "F F F", "1 1 1", 2, "binary");
    expectFailure(header + binaryRow(1, 2, 3), "announces 24 bytes of data, there are 12");
    expectFailure(header + binaryRow(1, 2, 3) + binaryRow(1, 2, 3) + "more", "more data");
    expectFailure(asciiPcd(3, "1 2 3\n4 5 6\n7 8"), "announces 3 points, there are 2");
    expectFailure(asciiPcd(1, "1 2 three\n"), "'three' is not a number");
    expectFailure("PLY\n", "no PCD file");
    expectFailure("", "no PCD file");
    expectFailure(pcdHeader("x y", "4 4", "F F", "1 1", 0, "ascii"), "no field z");
    expectFailure(pcdHeader("x y z", "4 4", "F F F", "1 1 1", 0, "ascii"),
                  "differ in length");
    expectFailure(pcdHeader("x y z", "4 4 3", "F F F", "1 1 1", 0, "ascii"),
                  "unknown type F3");
    expectFailure(pcdHeader("x y z", "4 4 4", "F F F", "1 1 -1", 0, "ascii"), "no count");
    expectFailure(pcdHeader("x y z", "4 4 4", "F F F", "1 1 1", 0, "text"),
                  "DATA is 'text'");
    expectFailure(pcdHeader("x y z", "4 4 4", "F F F", "1 1 1", 4000000000, "binary"),
                  "is truncated");
    // Chosen so that points times stride overflows to a small number.
    expectFailure(
        pcdHeader("x y z junk", "4 4 4 8", "F F F F", "1 1 1 4611686018", 4, "binary"),
        "more than a million columns");
    std::string noPoints = asciiPcd(1, "1 2 3\n");
    noPoints.replace(noPoints.find("POINTS 1\n"), 9, "");
    noPoints.replace(noPoints.find("WIDTH 1\nHEIGHT 1\n"), 17,
                     "WIDTH 8589934592\nHEIGHT 2147483648\n");
    expectFailure(noPoints, "WIDTH and HEIGHT are no counts");
}
