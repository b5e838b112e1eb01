#include <mrpt/maps/CColouredPointsMap.h>
#include <mrpt/maps/CPointsMapXYZI.h>

#include <algorithm>

#include "import_fixture.h"
#include "pcd_files.h"

using import_test::append;
using mrpt::obs::CObservationPointCloud;

namespace {

template <class T>
void appendBig(std::string& bytes, T value) {
    std::string one;
    append(one, value);
    std::reverse(one.begin(), one.end());
    bytes += one;
}

class ImportPly : public import_test::ImportTest {
 protected:
    CObservationPointCloud::Ptr importOne(const std::string& content) const {
        write("in/7.ply", content);
        write("poses.txt", import_test::tumLine(7, kPose));
        importIt("ply in --poses poses.txt");
        const auto log =
            import_test::readRawlog<CObservationPointCloud>(path("out.rawlog"));
        return log.empty() ? nullptr : log[0];
    }
    void expectPoints(const CObservationPointCloud& o) const {
        const auto points = import_test::worldPoints(o, poses()[0].T_world_frame);
        ASSERT_EQ(points.size(), 2U);
        const Eigen::Vector3d expected[] = {{1, 2, 3}, {-4, 5.5, 6}};
        for (std::size_t i = 0; i < 2; ++i)
            EXPECT_LT((points[i] - import_test::transform(kPose, expected[i])).norm(),
                      1e-5);
    }
    void expectFailure(const std::string& content, const std::string& what) const {
        write("in/7.ply", content);
        write("poses.txt", import_test::tumLine(7, kPose));
        const auto result =
            run("ply in --poses poses.txt -o out.rawlog --poses-out out.tum");
        EXPECT_EQ(result.exitCode, 1);
        EXPECT_NE(result.err.find("7.ply: "), std::string::npos) << result.err;
        EXPECT_NE(result.err.find(what), std::string::npos) << result.err;
    }
    const hgmm::Pose kPose = import_test::makePose(1, 2, 3, 0.4, 0.1, -0.2);
};

const std::string kColoured =
    "property double x\nproperty float y\nproperty float z\nproperty uchar red\n"
    "property uchar green\nproperty uchar blue\n";

}  // namespace

TEST_F(ImportPly, ReadsAsciiWithFacesAndOtherElements) {
    const auto o = importOne(
        "ply\r\nformat ascii 1.0\r\ncomment by hand\r\nelement camera 1\r\n"
        "property float fov\r\nelement vertex 2\r\nproperty float nx\r\nproperty float "
        "z\r\n"
        "property float y\r\nproperty float x\r\nproperty uchar intensity\r\n"
        "element face 1\r\nproperty list uchar int vertex_index\r\nend_header\r\n"
        "0.9\r\n0 3 2 1 51\r\n0 6 5.5 -4 255\r\n3 0 1 0\r\n");
    ASSERT_TRUE(o);
    expectPoints(*o);
    const auto cloud = std::dynamic_pointer_cast<mrpt::maps::CPointsMapXYZI>(o->pointcloud);
    ASSERT_TRUE(cloud);
    EXPECT_FLOAT_EQ(cloud->getPointIntensity(0), 0.2F);
}

TEST_F(ImportPly, ReadsBinaryOfEitherByteOrder) {
    const std::string header =
        " 1.0\nelement vertex 2\n" + kColoured + "element face 0\nend_header\n";
    std::string little = "ply\nformat binary_little_endian" + header;
    std::string big = "ply\nformat binary_big_endian" + header;
    const float rows[][3] = {{1, 2, 3}, {-4, 5.5F, 6}};
    for (const auto& row : rows) {
        append(little, static_cast<double>(row[0]));
        appendBig(big, static_cast<double>(row[0]));
        for (const int i : {1, 2}) append(little, row[i]), appendBig(big, row[i]);
        for (const char byte : {'\xFF', '\x80', '\0'}) little += byte, big += byte;
    }
    for (const auto& content : {little, big}) {
        const auto o = importOne(content);
        ASSERT_TRUE(o);
        expectPoints(*o);
        const auto cloud =
            std::dynamic_pointer_cast<mrpt::maps::CColouredPointsMap>(o->pointcloud);
        ASSERT_TRUE(cloud);
        float x = 0, y = 0, z = 0, r = 0, g = 0, b = 0;
        cloud->getPointRGB(1, x, y, z, r, g, b);
        EXPECT_NEAR(r, 1, 0.003);
        EXPECT_NEAR(g, 128 / 255.0, 0.003);
        EXPECT_NEAR(b, 0, 0.003);
    }
}

TEST_F(ImportPly, BadFilesAreNamed) {
    const std::string begin = "ply\nformat ascii 1.0\nelement vertex 2\n";
    const std::string places = "property float x\nproperty float y\nproperty float z\n";
    expectFailure("", "is no PLY file");
    expectFailure("solid\n", "is no PLY file");
    expectFailure(begin + places, "no end_header");
    expectFailure(begin + places + "end_header\n1 2 3\n4 5\n",
                  "announces 2 points, there are 1");
    expectFailure(begin + places + "end_header\n1 2 3\n4 5 six\n", "'six' is not a number");
    expectFailure(begin + "property float x\nend_header\n", "no field y");
    expectFailure(begin + "property float128 x\nend_header\n", "unknown type 'float128'");
    expectFailure(begin + places + "property list uchar int n\nend_header\n", "list");
    expectFailure("ply\nformat ascii 1.0\nend_header\n", "no element vertex");
    expectFailure("ply\nformat utf8 1.0\nelement vertex 0\n" + places + "end_header\n",
                  "format 'utf8'");
    expectFailure("ply\nformat binary_big_endian 1.0\nelement vertex 2\n" + places +
                      "end_header\n123",
                  "announces 24 bytes of data, there are 3");
}
