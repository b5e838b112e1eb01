#include <gtest/gtest.h>
#include <mrpt/maps/CHGMMOccupancyMap.h>

#include <cmath>
#include <cstdio>

#include "stock_app.h"

namespace fs = std::filesystem;

namespace {

// Odometry alone ends 8.8 m away. The program matches with the points map beside ours, so
// that the pose is MRPT's merit; MRPT's own test of it allows 1 m.
TEST(StockIcpSlam, ClosesTheLoopAndSavesOurMap) {
    const fs::path folder =
        fs::path(::testing::TempDir()) / ("hgmm-icp-slam-" + std::to_string(::getpid()));
    fs::create_directories(folder);
    fs::copy(fs::path(HGMM_CONFIG_FILES) / "icp-slam.ini", folder,
             fs::copy_options::overwrite_existing);
    const auto result = stock_app::run("icp-slam icp-slam.ini", folder);
    EXPECT_EQ(result.exitCode, 0) << result.output.substr(0, 4000);

    const auto at = result.output.rfind("currentPose=(");
    ASSERT_NE(at, std::string::npos) << result.output.substr(0, 4000);
    double x = 0, y = 0, yaw_deg = 0;
    ASSERT_EQ(std::sscanf(result.output.c_str() + at, "currentPose=(%lf,%lf,%lfdeg", &x, &y,
                          &yaw_deg),
              3);
    EXPECT_LT(std::hypot(x - 3.4548, y + 18.0399), 1.2);
    EXPECT_NEAR(yaw_deg, -86.48, 4);

    mrpt::maps::CHGMMOccupancyMap map;
    int saved = 0;
    for (const auto& entry : fs::recursive_directory_iterator(folder))
        if (entry.path().extension() == ".hgmm") {
            map.loadFromFile(entry.path().string());
            ++saved;
        }
    EXPECT_EQ(saved, 1);
    EXPECT_GT(map.model().mixture().size(), 100U);
    fs::remove_all(folder);
}

}  // namespace
