#include <mrpt/maps/CSimpleMap.h>
#include <mrpt/obs/CActionCollection.h>
#include <mrpt/obs/CActionRobotMovement3D.h>
#include <mrpt/obs/CRawlog.h>
#include <mrpt/obs/CSensoryFrame.h>

#include "import_fixture.h"
#include "pcd_files.h"

using mrpt::obs::CActionRobotMovement3D;

namespace {

constexpr int kScans = 201;

hgmm::Pose poseAt(int i) {
    return import_test::makePose(0.2 * i, std::sin(0.1 * i), 0.02 * i, 0.05 * i, 0.01 * i,
                                 -0.02);
}

/// A walk with one point a scan.
class ImportActions : public import_test::ImportTest {
 protected:
    void SetUp() override {
        import_test::ImportTest::SetUp();
        std::string lines;
        for (int i = 0; i < kScans; ++i) {
            lines += import_test::tumLine(50.5 + i, poseAt(i));
            write("in/" + std::to_string(i) + ".pcd", import_test::asciiPcd(1, "1 2 3\n"));
        }
        write("poses.txt", lines);
    }

    /// The movement of each pair, whose sensory frame must hold one observation.
    std::vector<CActionRobotMovement3D::Ptr> movements() const {
        mrpt::obs::CRawlog log;
        EXPECT_TRUE(log.loadFromRawLogFile(path("out.rawlog").string()));
        std::vector<CActionRobotMovement3D::Ptr> result;
        std::size_t entry = 0;
        mrpt::obs::CActionCollection::Ptr actions;
        mrpt::obs::CSensoryFrame::Ptr frame;
        while (entry < log.size() && log.getActionObservationPair(actions, frame, entry)) {
            EXPECT_EQ(frame->size(), 1U);
            result.push_back(actions->getActionByClass<CActionRobotMovement3D>());
        }
        return result;
    }
};

}  // namespace

TEST_F(ImportActions, ExactMovementsComposeBackToThePoses) {
    importIt("pcd in --poses poses.txt --actions");
    const auto actions = movements();
    const auto trajectory = poses();
    ASSERT_EQ(actions.size(), std::size_t(kScans));
    ASSERT_EQ(trajectory.size(), std::size_t(kScans));
    hgmm::Pose pose = poseAt(0);
    for (std::size_t i = 0; i < actions.size(); ++i) {
        ASSERT_TRUE(actions[i]);
        pose = pose * import_test::toPose(actions[i]->poseChange.mean);
        EXPECT_LT(import_test::poseDistance(pose, poseAt(int(i))), 1e-9);
        EXPECT_NEAR(mrpt::Clock::toDouble(actions[i]->timestamp), trajectory[i].stamp,
                    1e-6);
        // A particle filter draws from this covariance.
        EXPECT_GT(actions[i]->poseChange.cov.asEigen().eigenvalues().real().minCoeff(),
                  1e-6);
    }
}

TEST_F(ImportActions, NoiseHasTheStatedDeviationAndSeed) {
    const std::string arguments =
        "pcd in --poses poses.txt --actions --odometry-noise 0.05,2";
    importIt(arguments);
    const auto actions = movements();
    ASSERT_EQ(actions.size(), std::size_t(kScans));
    Eigen::Matrix<double, 6, 1> squares = Eigen::Matrix<double, 6, 1>::Zero();
    for (int i = 1; i < kScans; ++i) {
        const auto exact = poseAt(i - 1).inverse() * poseAt(i);
        const auto& movement = *actions[std::size_t(i)];
        const auto error = exact.inverse() * import_test::toPose(movement.poseChange.mean);
        squares.head<3>() += error.t.cwiseAbs2();
        const Eigen::AngleAxisd rotation(error.R);
        squares.tail<3>() += (rotation.angle() * rotation.axis()).cwiseAbs2();
        EXPECT_NEAR(movement.poseChange.cov(0, 0), 0.05 * 0.05, 1e-12);
        EXPECT_NEAR(movement.poseChange.cov(3, 3), std::pow(2 * M_PI / 180, 2), 1e-12);
    }
    const Eigen::Matrix<double, 6, 1> sigmas = (squares / (kScans - 1)).cwiseSqrt();
    // 200 draws: the sample deviation is within 20 % at 4 sigma.
    for (int i = 0; i < 3; ++i) EXPECT_NEAR(sigmas[i], 0.05, 0.01);
    for (int i = 3; i < 6; ++i) EXPECT_NEAR(sigmas[i], 2 * M_PI / 180, 0.4 * M_PI / 180);

    const std::string first = import_test::readText(path("out.rawlog"));
    importIt(arguments + " --seed 1");
    EXPECT_EQ(import_test::readText(path("out.rawlog")), first) << "same seed, same bytes";
    importIt(arguments + " --seed 2");
    EXPECT_NE(import_test::readText(path("out.rawlog")), first);
}

TEST_F(ImportActions, SimpleMapHoldsPosesAndScans) {
    importIt("pcd in --poses poses.txt --step 50 --simplemap out.simplemap");
    mrpt::maps::CSimpleMap map;
    ASSERT_TRUE(map.loadFromFile(path("out.simplemap").string()));
    ASSERT_EQ(map.size(), 5U);
    int number = 0;
    for (const auto& keyframe : map) {
        const auto mean = import_test::toPose(keyframe.pose->getMeanVal());
        EXPECT_LT(import_test::poseDistance(mean, poseAt(50 * number++)), 1e-9);
        const auto o =
            keyframe.sf->getObservationByClass<mrpt::obs::CObservationPointCloud>();
        ASSERT_TRUE(o);
        EXPECT_EQ(o->pointcloud->size(), 1U);
    }
}
