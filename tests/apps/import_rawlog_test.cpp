#include <mrpt/io/CFileGZOutputStream.h>
#include <mrpt/obs/CActionCollection.h>
#include <mrpt/obs/CActionRobotMovement2D.h>
#include <mrpt/obs/CObservation2DRangeScan.h>
#include <mrpt/obs/CObservationOdometry.h>
#include <mrpt/obs/CObservationPointCloud.h>
#include <mrpt/obs/CRawlog.h>
#include <mrpt/serialization/CArchive.h>

#include "import_fixture.h"

using import_test::ImportTest;
using mrpt::obs::CObservation2DRangeScan;
using mrpt::poses::CPose2D;

namespace {

CPose2D robotAt(int i) {
    return CPose2D(0.5 * i, 0.1 * i, 0.2 * i);
}

/// Logs of single observations: odometry, then a laser scan.
class ImportRawlog : public ImportTest {
 protected:
    enum class Scans { planar, clouds, both };
    void writeLog(int scans, Scans kinds = Scans::planar) const {
        mrpt::io::CFileGZOutputStream stream(path("in.rawlog").string());
        auto archive = mrpt::serialization::archiveFrom(stream);
        for (int i = 0; i < scans; ++i) {
            mrpt::obs::CObservationOdometry odometry;
            odometry.timestamp = mrpt::Clock::fromDouble(1e9 + i);
            odometry.odometry = robotAt(i);
            archive << odometry;
            CObservation2DRangeScan scan;
            scan.timestamp = odometry.timestamp;
            scan.aperture = 1.5F;
            scan.resizeScanAndAssign(11, 2.F + float(i), true);
            scan.setScanRangeValidity(4, false);
            scan.maxRange = 12.5F;
            if (kinds != Scans::clouds) archive << scan;
            if (kinds == Scans::planar) continue;
            mrpt::obs::CObservationPointCloud cloud;
            cloud.timestamp = odometry.timestamp;
            cloud.pointcloud = mrpt::maps::CSimplePointsMap::Create();
            cloud.pointcloud->insertPoint(1, 2, 3);
            archive << cloud;
        }
    }
};

TEST_F(ImportRawlog, ApertureIsPutRightAndOdometryBecomesPoses) {
    writeLog(4);
    importIt("rawlog in.rawlog --aperture 179");
    const auto scans = import_test::readRawlog<CObservation2DRangeScan>(path("out.rawlog"));
    ASSERT_EQ(scans.size(), 4U);
    expectStampsMatch(scans);
    for (int i = 0; i < 4; ++i) {
        const auto& scan = *scans[std::size_t(i)];
        EXPECT_NEAR(scan.aperture, mrpt::DEG2RAD(179.0), 1e-6);
        EXPECT_EQ(scan.getScanRange(3), 2.F + float(i));
        EXPECT_TRUE(scan.getScanRangeValidity(3));
        EXPECT_FALSE(scan.getScanRangeValidity(4));
        EXPECT_EQ(scan.maxRange, 12.5F);
        EXPECT_LT(import_test::poseDistance(
                      poses()[std::size_t(i)].T_world_frame,
                      import_test::toPose(mrpt::poses::CPose3D(robotAt(i)))),
                  1e-6);
    }
    importIt("rawlog in.rawlog");
    EXPECT_EQ(
        import_test::readRawlog<CObservation2DRangeScan>(path("out.rawlog"))[0]->aperture,
        1.5F);
}

TEST_F(ImportRawlog, OdometryBecomesPosesOfCloudsToo) {
    writeLog(3, Scans::both);
    const auto mixed = importIt("rawlog in.rawlog");
    EXPECT_NE(mixed.err.find("3 planar scans and 3 others"), std::string::npos);
    EXPECT_NE(mixed.out.find("by the log's odometry"), std::string::npos) << mixed.out;
    writeLog(3, Scans::clouds);
    importIt("rawlog in.rawlog");
    const auto clouds =
        import_test::readRawlog<mrpt::obs::CObservationPointCloud>(path("out.rawlog"));
    ASSERT_EQ(clouds.size(), 3U);
    EXPECT_EQ(clouds[2]->pointcloud->size(), 1U);
    for (int i = 0; i < 3; ++i)
        EXPECT_LT(import_test::poseDistance(
                      poses()[std::size_t(i)].T_world_frame,
                      import_test::toPose(mrpt::poses::CPose3D(robotAt(i)))),
                  1e-6);
}

TEST_F(ImportRawlog, DataBesideTheLogIsWrittenIntoTheNewOne) {
    std::filesystem::create_directories(path("in_Images"));
    {
        mrpt::io::CFileGZOutputStream stream(path("in.rawlog").string());
        auto archive = mrpt::serialization::archiveFrom(stream);
        mrpt::obs::CObservation3DRangeScan scan;
        scan.timestamp = mrpt::Clock::fromDouble(1e9);
        scan.hasRangeImage = true;
        scan.rangeUnits = 1e-3F;
        scan.rangeImage_setSize(4, 5);
        scan.rangeImage.fill(2500);
        scan.rangeImage_convertToExternalStorage("depth.bin", path("in_Images/").string());
        archive << scan;
    }
    importIt("rawlog in.rawlog");
    std::filesystem::remove_all(path("in_Images"));
    const auto scans =
        import_test::readRawlog<mrpt::obs::CObservation3DRangeScan>(path("out.rawlog"));
    ASSERT_EQ(scans.size(), 1U);
    ASSERT_FALSE(scans[0]->rangeImage_isExternallyStored());
    ASSERT_EQ(scans[0]->rangeImage.rows(), 4);
    EXPECT_EQ(scans[0]->rangeImage(3, 4), 2500);
}

// Stock rbpf-slam needs pairs, and moves particles as the actions say.
TEST_F(ImportRawlog, ActionsAreTheOdometryIn2D) {
    writeLog(3);
    importIt("rawlog in.rawlog --actions --turn-error 5");
    mrpt::obs::CRawlog log;
    ASSERT_TRUE(log.loadFromRawLogFile(path("out.rawlog").string()));
    ASSERT_EQ(log.size(), 6U);
    for (std::size_t i = 0; i < 3; ++i) {
        const auto move =
            log.getAsAction(2 * i)->getActionByClass<mrpt::obs::CActionRobotMovement2D>();
        ASSERT_TRUE(move);
        const CPose2D expected = i == 0 ? CPose2D() : robotAt(int(i)) - robotAt(int(i) - 1);
        const CPose2D got = move->rawOdometryIncrementReading;
        EXPECT_NEAR((got - expected).norm(), 0, 1e-6);
        EXPECT_NEAR(got.phi(), expected.phi(), 1e-6);
        EXPECT_NEAR(move->motionModelConfiguration.gaussianModel.a3, mrpt::DEG2RAD(5.0),
                    1e-6);
        const auto frame = log.getAsObservations(2 * i + 1);
        EXPECT_TRUE(frame->getObservationByClass<CObservation2DRangeScan>());
    }
    // Noise is stated, so that a filter can follow.
    importIt("rawlog in.rawlog --actions --odometry-noise 0.2,3");
    mrpt::obs::CRawlog noisy;
    ASSERT_TRUE(noisy.loadFromRawLogFile(path("out.rawlog").string()));
    const auto move =
        noisy.getAsAction(2)->getActionByClass<mrpt::obs::CActionRobotMovement2D>();
    EXPECT_GT((move->rawOdometryIncrementReading - (robotAt(1) - robotAt(0))).norm(), 1e-3);
    EXPECT_NEAR(move->motionModelConfiguration.gaussianModel.minStdXY, 0.2, 1e-6);
    EXPECT_NEAR(move->motionModelConfiguration.gaussianModel.minStdPHI, mrpt::DEG2RAD(3.0),
                1e-6);
    importIt("rawlog in.rawlog --actions");
    // A log of pairs is read as well.
    std::filesystem::rename(path("out.rawlog"), path("pairs.rawlog"));
    importIt("rawlog pairs.rawlog");
    EXPECT_EQ(import_test::readRawlog<CObservation2DRangeScan>(path("out.rawlog")).size(),
              3U);
}

TEST_F(ImportRawlog, RefusesWhatItCannotUse) {
    write("text.rawlog", "not a log");
    for (const char* name : {"gone.rawlog", "text.rawlog"}) {
        const auto outcome =
            run("rawlog " + std::string(name) + " -o out.rawlog --poses-out out.tum");
        EXPECT_EQ(outcome.exitCode, 1) << name;
        EXPECT_NE(outcome.err.find(name), std::string::npos) << outcome.err;
    }
    writeLog(2, Scans::clouds);
    const auto outcome =
        run("rawlog in.rawlog -o out.rawlog --poses-out out.tum --aperture 180");
    EXPECT_EQ(outcome.exitCode, 1);
    EXPECT_NE(outcome.err.find("no 2D range scan"), std::string::npos) << outcome.err;
    for (const char* bad : {"--aperture 0", "--aperture 400", "--turn-error 5"})
        EXPECT_EQ(
            run("rawlog in.rawlog -o out.rawlog --poses-out out.tum " + std::string(bad))
                .exitCode,
            2)
            << bad;
}

}  // namespace
