#include <mrpt/maps/CSimpleMap.h>
#include <mrpt/obs/CObservation2DRangeScan.h>
#include <mrpt/obs/CObservationOdometry.h>
#include <mrpt/obs/CObservationPointCloud.h>
#include <mrpt/obs/CSensoryFrame.h>
#include <mrpt/poses/CPose3DPDFGaussian.h>

#include "import_fixture.h"

using import_test::ImportTest;
using import_test::poseDistance;
using mrpt::poses::CPose3D;

namespace {

CPose3D frameAt(int i) {
    return CPose3D(0.3 * i, 1, 0, 0.1 * i, 0, 0);
}

/// Simple maps of laser scans with odometry between them, and what they become.
class ImportSimpleMap : public ImportTest {
 protected:
    void writeMap(int frames, double secondsPerFrame) const {
        mrpt::maps::CSimpleMap map;
        for (int i = 0; i < frames; ++i) {
            auto scan = mrpt::obs::CObservation2DRangeScan::Create();
            scan->timestamp = mrpt::Clock::fromDouble(1e9 + secondsPerFrame * i);
            scan->sensorPose = CPose3D(0.1, 0, 0.2, 0, 0, 0);
            scan->aperture = 1.F;
            scan->resizeScanAndAssign(11, 2.F + float(i), true);
            auto frame = mrpt::obs::CSensoryFrame::Create();
            frame->insert(mrpt::obs::CObservationOdometry::Create());
            frame->insert(scan);
            map.insert(mrpt::poses::CPose3DPDFGaussian::Create(frameAt(i)), frame);
        }
        ASSERT_TRUE(map.saveToFile(path("in.simplemap").string()));
    }
};

TEST_F(ImportSimpleMap, ScansKeepPosesAndTimes) {
    writeMap(4, 0.5);
    importIt("simplemap in.simplemap");
    const auto scans =
        import_test::readRawlog<mrpt::obs::CObservation2DRangeScan>(path("out.rawlog"));
    ASSERT_EQ(scans.size(), 4U);
    expectStampsMatch(scans);
    const auto trajectory = poses();
    for (int i = 0; i < 4; ++i) {
        EXPECT_NEAR(trajectory[std::size_t(i)].stamp, 1e9 + 0.5 * i, 1e-5);
        EXPECT_LT(poseDistance(trajectory[std::size_t(i)].T_world_frame,
                               import_test::toPose(frameAt(i))),
                  1e-6);
        EXPECT_EQ(scans[std::size_t(i)]->getScanRange(3), 2.F + float(i));
        EXPECT_NEAR(scans[std::size_t(i)]->sensorPose.x(), 0.1, 1e-9);
    }
}

TEST_F(ImportSimpleMap, StampsThatGoBackAreReplaced) {
    writeMap(3, -0.5);
    const auto outcome = importIt("simplemap in.simplemap");
    EXPECT_NE((outcome.out + outcome.err).find("go back"), std::string::npos);
    EXPECT_NEAR(poses()[2].stamp - poses()[0].stamp, 0.2, 1e-9);
}

TEST_F(ImportSimpleMap, RefusesWhatIsNone) {
    write("text.simplemap", "not a map");
    mrpt::maps::CSimpleMap().saveToFile(path("empty.simplemap").string());
    for (const char* name : {"gone.simplemap", "text.simplemap", "empty.simplemap"}) {
        const auto outcome =
            run(std::string("simplemap ") + name + " -o out.rawlog --poses-out out.tum");
        EXPECT_EQ(outcome.exitCode, 1) << name;
        EXPECT_NE(outcome.err.find(name), std::string::npos) << outcome.err;
        EXPECT_FALSE(std::filesystem::exists(path("out.rawlog")));
    }
}

// All points in the world frame, in one cloud at the origin.
TEST_F(ImportSimpleMap, CloudHoldsAllPointsInTheWorldFrame) {
    writeMap(2, 0.5);
    importIt("simplemap in.simplemap --cloud cloud.simplemap");
    mrpt::maps::CSimpleMap map;
    ASSERT_TRUE(map.loadFromFile(path("cloud.simplemap").string()));
    ASSERT_EQ(map.size(), 1U);
    const auto& keyframe = *map.begin();
    EXPECT_EQ(keyframe.pose->getMeanVal(), CPose3D());
    const auto observation =
        keyframe.sf->getObservationByClass<mrpt::obs::CObservationPointCloud>();
    ASSERT_TRUE(observation);
    ASSERT_EQ(observation->pointcloud->size(), 22U);
    // The middle ray of each scan looks ahead from its sensor.
    for (int i = 0; i < 2; ++i) {
        const auto expected = (frameAt(i) + CPose3D(0.1, 0, 0.2, 0, 0, 0))
                                  .composePoint(mrpt::math::TPoint3D(2.0 + i, 0, 0));
        float x = 0, y = 0, z = 0;
        observation->pointcloud->getPoint(std::size_t(11 * i + 5), x, y, z);
        EXPECT_NEAR(x, expected.x, 1e-5);
        EXPECT_NEAR(y, expected.y, 1e-5);
        EXPECT_NEAR(z, expected.z, 1e-5);
    }
    EXPECT_EQ(run("simplemap in.simplemap -o a --poses-out b --cloud b").exitCode, 1);
}

}  // namespace
