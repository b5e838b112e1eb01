#include <gtest/gtest.h>

#include "hgmm/mrpt_bridge/mrpt_compat.h"
#include "hgmm/mrpt_bridge/observation_to_scan.h"
#include "observations.h"
#if __has_include(<mrpt/maps/CPointsMapXYZIRT.h>)
#include <mrpt/maps/CPointsMapXYZIRT.h>
#endif

namespace {

hgmm::Scan scanOf(const mrpt::maps::CPointsMap::Ptr& cloud) {
    const auto o = observations::cloud();
    o->pointcloud = cloud;
    return hgmm::mrpt_bridge::observationToScan(*o).value();
}

// Later releases insert places without values.
TEST(MrptCompat, CloudsOfPlacesAloneHaveNoChannels) {
    const auto grey = mrpt::maps::CPointsMapXYZI::Create();
    const auto coloured = mrpt::maps::CColouredPointsMap::Create();
    for (const mrpt::maps::CPointsMap::Ptr& cloud :
         {mrpt::maps::CPointsMap::Ptr(grey), mrpt::maps::CPointsMap::Ptr(coloured)}) {
        cloud->insertPointFast(1, 2, 3);
        const hgmm::Scan scan = scanOf(cloud);
        EXPECT_EQ(scan.size(), 1U);
#if HGMM_MRPT_HAS_NEAREST_NEIGHBOURS
        EXPECT_TRUE(scan.channels.empty());
#endif
    }
}

#if __has_include(<mrpt/maps/CPointsMapXYZIRT.h>)
TEST(MrptCompat, EveryCloudWithIntensitiesBringsThem) {
    const auto cloud = mrpt::maps::CPointsMapXYZIRT::Create();
    cloud->insertPointFast(1, 2, 3);
    EXPECT_TRUE(scanOf(cloud).channels.empty());
    cloud->insertPointField_Intensity(0.25F);
    const hgmm::Scan scan = scanOf(cloud);
    ASSERT_EQ(scan.channels.size(), 1U);
    EXPECT_EQ(scan.channels[0].name, "intensity");
    EXPECT_EQ(scan.channels[0].values, std::vector<float>{0.25F});
}
#endif

}  // namespace
