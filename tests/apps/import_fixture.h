#pragma once
#include <gtest/gtest.h>
#include <hgmm/evaluation/trajectory.h>
#include <mrpt/core/Clock.h>
#include <mrpt/img/CImage.h>
#include <mrpt/io/CFileGZInputStream.h>
#include <mrpt/maps/CSimplePointsMap.h>
#include <mrpt/obs/CObservation3DRangeScan.h>
#include <mrpt/obs/CObservationPointCloud.h>
#include <mrpt/serialization/CArchive.h>
#include <sys/wait.h>
#include <unistd.h>

#include <Eigen/Geometry>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <memory>
#include <string>
#include <vector>

namespace import_test {

/// What one run of hgmm-import ended with and said.
struct Outcome {
    int exitCode = -1;
    std::string out, err;
};

inline std::string readText(const std::filesystem::path& file) {
    std::ifstream in(file, std::ios::binary);
    return {std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>()};
}

/// The objects of a gzip-compressed rawlog.
template <class T>
std::vector<std::shared_ptr<T>> readRawlog(const std::filesystem::path& file) {
    mrpt::io::CFileGZInputStream stream(file.string());
    auto archive = mrpt::serialization::archiveFrom(stream);
    std::vector<std::shared_ptr<T>> objects;
    try {
        while (true) {
            auto object = archive.ReadObject();
            auto wanted = std::dynamic_pointer_cast<T>(object);
            if (!wanted) {
                ADD_FAILURE() << "unexpected " << object->GetRuntimeClass()->className;
                break;
            }
            objects.push_back(wanted);
        }
    } catch (const mrpt::serialization::CExceptionEOF&) {
    }
    return objects;
}

inline hgmm::Pose toPose(const mrpt::poses::CPose3D& pose) {
    hgmm::Pose result;
    result.R = pose.getRotationMatrix().asEigen();
    result.t = {pose.x(), pose.y(), pose.z()};
    return result;
}

inline hgmm::Pose makePose(double x, double y, double z, double yaw, double pitch,
                           double roll) {
    return toPose(mrpt::poses::CPose3D(x, y, z, yaw, pitch, roll));
}

inline Eigen::Vector3d transform(const hgmm::Pose& pose, const Eigen::Vector3d& p) {
    return pose.R * p + pose.t;
}

inline double poseDistance(const hgmm::Pose& a, const hgmm::Pose& b) {
    return std::max((a.R - b.R).cwiseAbs().maxCoeff(), (a.t - b.t).cwiseAbs().maxCoeff());
}

inline std::string numbers(const std::vector<double>& values) {
    std::string text;
    char word[40];
    for (const double value : values) {
        std::snprintf(word, sizeof word, "%.17g ", value);
        text += word;
    }
    return text;
}

inline std::string tumLine(double stamp, const hgmm::Pose& pose) {
    const Eigen::Quaterniond q(pose.R);
    return numbers(
               {stamp, pose.t.x(), pose.t.y(), pose.t.z(), q.x(), q.y(), q.z(), q.w()}) +
           "\n";
}

/// The first three rows of the pose's matrix: a KITTI line.
inline std::string kittiLine(const hgmm::Pose& pose) {
    std::vector<double> v;
    for (int row = 0; row < 3; ++row) {
        for (int col = 0; col < 3; ++col) v.push_back(pose.R(row, col));
        v.push_back(pose.t(row));
    }
    return numbers(v) + "\n";
}

/// The bytes of values in memory.
template <class T>
std::string bytesOf(const std::vector<T>& values) {
    return {reinterpret_cast<const char*>(values.data()), values.size() * sizeof(T)};
}

/// A temporary folder, and the program run in it.
class ImportTest : public testing::Test {
 protected:
    void SetUp() override {
        std::string name =
            (std::filesystem::temp_directory_path() / "hgmm-import-XXXXXX").string();
        ASSERT_NE(mkdtemp(name.data()), nullptr);
        folder_ = name;
    }
    void TearDown() override { std::filesystem::remove_all(folder_); }

    std::filesystem::path path(const std::string& name) const { return folder_ / name; }

    void write(const std::string& name, const std::string& text) const {
        std::filesystem::create_directories(path(name).parent_path());
        std::ofstream(path(name), std::ios::binary) << text;
    }

    /// Runs `hgmm-import ARGUMENTS` in the folder.
    Outcome run(const std::string& arguments) const {
        const std::string command = "cd '" + folder_.string() +
                                    "' && '" HGMM_BIN_DIR "/hgmm-import' " + arguments +
                                    " </dev/null >stdout.txt 2>stderr.txt";
        const int status = std::system(command.c_str());
        Outcome result;
        result.exitCode = WIFEXITED(status) ? WEXITSTATUS(status) : -1;
        result.out = readText(path("stdout.txt"));
        result.err = readText(path("stderr.txt"));
        return result;
    }

    /// Runs it with out.rawlog and out.tum as outputs; it must succeed.
    Outcome importIt(const std::string& arguments) const {
        const Outcome result = run(arguments + " -o out.rawlog --poses-out out.tum");
        EXPECT_EQ(result.exitCode, 0) << result.err;
        return result;
    }

    hgmm::evaluation::Trajectory poses() const {
        return hgmm::evaluation::readTrajectory(path("out.tum").string());
    }

    /// Each observation has its pose in the file, at the same time.
    template <class T>
    void expectStampsMatch(const std::vector<std::shared_ptr<T>>& observations) const {
        const auto trajectory = poses();
        ASSERT_EQ(observations.size(), trajectory.size());
        for (std::size_t i = 0; i < trajectory.size(); ++i) {
            EXPECT_NE(observations[i]->timestamp, INVALID_TIMESTAMP);
            EXPECT_NEAR(mrpt::Clock::toDouble(observations[i]->timestamp),
                        trajectory[i].stamp, 2e-6);
        }
    }

 private:
    std::filesystem::path folder_;
};

/// A small depth image that is zero but for some pixels.
struct DepthPixel {
    unsigned row, col;
    std::uint16_t value;
};

constexpr unsigned kRows = 48, kCols = 64;

inline void writeDepth(const std::filesystem::path& file,
                       const std::vector<DepthPixel>& pixels) {
    std::filesystem::create_directories(file.parent_path());
    mrpt::img::CImage image;
    image.resize(kCols, kRows, mrpt::img::CH_GRAY, mrpt::img::PixelDepth::D16U);
    for (unsigned row = 0; row < kRows; ++row)
        std::fill_n(image.ptrLine<std::uint16_t>(row), kCols, std::uint16_t{0});
    for (const auto& p : pixels) image.ptrLine<std::uint16_t>(p.row)[p.col] = p.value;
    ASSERT_TRUE(image.saveToFile(file.string()));
}

inline void writeColor(const std::filesystem::path& file, std::uint8_t brightness,
                       unsigned cols = kCols) {
    std::filesystem::create_directories(file.parent_path());
    mrpt::img::CImage image(cols, kRows, mrpt::img::CH_RGB);
    image.filledRectangle(0, 0, static_cast<int>(cols), static_cast<int>(kRows),
                          mrpt::img::TColor(brightness, brightness, brightness));
    ASSERT_TRUE(image.saveToFile(file.string()));
}

/// The world points of a depth observation, as MRPT itself computes them.
inline std::vector<Eigen::Vector3d> worldPoints(mrpt::obs::CObservation3DRangeScan& o,
                                                const hgmm::Pose& T_world_robot) {
    mrpt::obs::T3DPointsProjectionParams projection;
    projection.takeIntoAccountSensorPoseOnRobot = true;
    mrpt::math::CMatrixDouble31 translation;
    for (int i = 0; i < 3; ++i) translation[i] = T_world_robot.t[i];
    projection.robotPoseInTheWorld =
        mrpt::poses::CPose3D(mrpt::math::CMatrixDouble33(T_world_robot.R), translation);
    mrpt::maps::CSimplePointsMap map;
    o.unprojectInto(map, projection);
    std::vector<Eigen::Vector3d> points;
    for (std::size_t i = 0; i < map.size(); ++i) {
        float x = 0, y = 0, z = 0;
        map.getPointFast(i, x, y, z);
        points.emplace_back(x, y, z);
    }
    return points;
}

/// The world points of a cloud observation: pose, then sensorPose, then point.
inline std::vector<Eigen::Vector3d> worldPoints(const mrpt::obs::CObservationPointCloud& o,
                                                const hgmm::Pose& T_world_robot) {
    const hgmm::Pose T_world_sensor = T_world_robot * toPose(o.sensorPose);
    std::vector<Eigen::Vector3d> points;
    for (std::size_t i = 0; i < o.pointcloud->size(); ++i) {
        float x = 0, y = 0, z = 0;
        o.pointcloud->getPointFast(i, x, y, z);
        points.push_back(transform(T_world_sensor, {x, y, z}));
    }
    return points;
}

}  // namespace import_test
