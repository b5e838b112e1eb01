#include <gtest/gtest.h>
#include <mrpt/poses/CPose2D.h>
#include <mrpt/poses/CPose3DPDFGaussian.h>
#include <mrpt/poses/CPosePDFGaussian.h>
#include <mrpt/slam/CICP.h>

#include "laser_room.h"
#include "lit_room.h"

using mrpt::maps::CHGMMOccupancyMap;
using mrpt::maps::CSimplePointsMap;
using mrpt::poses::CPose2D;
using mrpt::poses::CPose3D;

/// mrpt::slam::CICP with our map as its reference.
namespace {

TEST(Icp, AlignsALaserScan) {
    const CHGMMOccupancyMap map = laser_room::map();
    const CSimplePointsMap points = laser_room::points();
    mrpt::slam::CICP icp;
    icp.options.maxIterations = 100;
    const CPose2D truth(0.4, -0.3, 0.2);
    CSimplePointsMap moved;
    moved.changeCoordinatesReference(points, -CPose3D(truth));
    for (const CPose2D& off : {CPose2D(0.3, 0.2, 0.05), CPose2D(-0.3, 0.25, -0.08)}) {
        mrpt::slam::CICP::TReturnInfo info;
        const auto pdf = icp.Align(&map, &moved, truth + off, info);
        const CPose2D error = pdf->getMeanVal() - truth;
        EXPECT_LT(error.norm(), 0.03) << error;
        EXPECT_LT(std::abs(error.phi()), mrpt::DEG2RAD(0.5)) << error;
        EXPECT_GT(info.goodness, 0.9);
    }
}

TEST(Icp, AlignsAScanInSpace) {
    const CHGMMOccupancyMap map = lit_room::map();
    const Eigen::Vector3d at = lit_room::kMiddle_map + Eigen::Vector3d(0.2, -0.1, 0.1);
    const CPose3D truth(at.x(), at.y(), at.z(), 0, 0, 0);
    CSimplePointsMap points;
    points.insertAnotherMap(lit_room::scan({0.2, -0.1, 0.1}, 9)->pointcloud.get(),
                            CPose3D());
    mrpt::slam::CICP icp;
    icp.options.maxIterations = 100;
    mrpt::slam::CICP::TReturnInfo info;
    const auto pdf = icp.Align3D(&map, &points,
                                 truth + CPose3D(0.2, -0.15, 0.2, 0.06, -0.04, 0.05), info);
    const CPose3D error = CPose3D(pdf->getMeanVal()) - truth;
    EXPECT_LT(error.norm(), 0.02) << error;
    EXPECT_LT(std::abs(error.yaw()) + std::abs(error.pitch()) + std::abs(error.roll()),
              mrpt::DEG2RAD(0.6))
        << error;
    EXPECT_GT(info.goodness, 0.95);
}

}  // namespace
