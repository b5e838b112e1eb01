#include <hgmm/evaluation/trajectory.h>

#include "import_fixture.h"

using mrpt::obs::CObservation3DRangeScan;
using mrpt::obs::CObservationPointCloud;

namespace {

/// The recordings in HGMM_DATA_DIR, which are not part of this project.
class ImportRecordings : public import_test::ImportTest {
 protected:
    void SetUp() override {
        import_test::ImportTest::SetUp();
        const char* folder = std::getenv("HGMM_DATA_DIR");
        if (!folder) GTEST_SKIP() << "SKIPPED: HGMM_DATA_DIR is not set";
        data_ = std::filesystem::absolute(folder).string() + "/";
    }
    /// The poses written are those of the dataset's own file, line by line.
    void expectPosesOf(const std::string& file, double tolerance) const {
        const auto expected = hgmm::evaluation::readTrajectory(data_ + file);
        const auto written = poses();
        ASSERT_LE(written.size(), expected.size());
        for (std::size_t i = 0; i < written.size(); ++i) {
            EXPECT_NEAR(written[i].stamp, expected[i].stamp, 2e-6);
            EXPECT_LT(import_test::poseDistance(written[i].T_world_frame,
                                                expected[i].T_world_frame),
                      tolerance);
        }
    }
    std::string data_;
};

}  // namespace

TEST_F(ImportRecordings, Kitchen) {
    importIt("7scenes '" + data_ + "rgbd_kitchen'");
    const auto log = import_test::readRawlog<CObservation3DRangeScan>(path("out.rawlog"));
    ASSERT_EQ(log.size(), 250U);
    expectStampsMatch(log);
    expectPosesOf("rgbd_kitchen/poses_tum.txt", 5e-5);
    EXPECT_EQ(log[0]->rangeImage(240, 320), 1382);
    EXPECT_TRUE(log[249]->hasIntensityImage);
}

TEST_F(ImportRecordings, Livox) {
    importIt("pcd '" + data_ + "livox_building/scans' --poses '" + data_ +
             "livox_building/poses_tum.txt' --sensor-pose 0.0417,0.0233,-0.0284,0,0,0");
    const auto log = import_test::readRawlog<CObservationPointCloud>(path("out.rawlog"));
    ASSERT_EQ(log.size(), 457U);
    expectStampsMatch(log);
    expectPosesOf("livox_building/poses_tum.txt", 1e-6);
    EXPECT_NEAR(log[0]->sensorPose.z(), -0.0284, 1e-12);
}

TEST_F(ImportRecordings, Lidar16Room) {
    importIt("pcd '" + data_ + "lidar16_room_sim' --poses '" + data_ +
             "lidar16_room_sim/poses_tum.txt'");
    const auto log = import_test::readRawlog<CObservationPointCloud>(path("out.rawlog"));
    ASSERT_EQ(log.size(), 21U);
    expectPosesOf("lidar16_room_sim/poses_tum.txt", 1e-6);
    // A box room of 30 x 20 x 8.2 m: with the right poses, all of it is within.
    Eigen::AlignedBox3d room;
    const auto trajectory = poses();
    for (std::size_t i = 0; i < log.size(); ++i)
        for (const auto& p : import_test::worldPoints(*log[i], trajectory[i].T_world_frame))
            room.extend(p);
    EXPECT_LT(room.sizes().x(), 30.1);
    EXPECT_LT(room.sizes().y(), 20.1);
    EXPECT_LT(room.sizes().z(), 8.3);
}

TEST_F(ImportRecordings, La3dm) {
    for (const char* name : {"sim_structured", "sim_unstructured"}) {
        importIt("pcd '" + data_ + "la3dm_sim/" + name + "' --world-frame");
        const auto log =
            import_test::readRawlog<CObservationPointCloud>(path("out.rawlog"));
        ASSERT_EQ(log.size(), 12U);
        // A room of 11 x 20 x 4.3 m with the sensors inside.
        Eigen::AlignedBox3d room;
        const auto trajectory = poses();
        for (std::size_t i = 0; i < log.size(); ++i)
            for (const auto& p :
                 import_test::worldPoints(*log[i], trajectory[i].T_world_frame))
                room.extend(p);
        for (const auto& pose : trajectory)
            EXPECT_TRUE(room.contains(pose.T_world_frame.t))
                << pose.T_world_frame.t.transpose();
        EXPECT_LT(room.sizes().maxCoeff(), 21);
    }
}
