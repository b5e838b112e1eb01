#include <gtest/gtest.h>
#include <mrpt/maps/CHGMMOccupancyMap.h>
#include <mrpt/poses/CPose3DQuat.h>
#include <mrpt/tfest/se3.h>

#include <map>

#include "lit_room.h"

using mrpt::maps::CHGMMOccupancyMap;
using mrpt::poses::CPose3D;

namespace {

#if HGMM_MRPT_HAS_NEAREST_NEIGHBOURS
/// How mp2p_icp comes to the interface.
const mrpt::maps::NearestNeighborsCapable& neighboursOf(const mrpt::maps::CMetricMap& map) {
    return dynamic_cast<const mrpt::maps::NearestNeighborsCapable&>(map);
}
#else
const CHGMMOccupancyMap& neighboursOf(const mrpt::maps::CMetricMap& map) {
    return dynamic_cast<const CHGMMOccupancyMap&>(map);
}
#endif

// As mp2p_icp's matcher of points does, which knows nothing of surfaces: of all points with
// the same neighbour, by its ID, the nearest.
TEST(NeighbourMatching, PairsOfPointsAlignAScan) {
    const CHGMMOccupancyMap::Ptr map = std::make_shared<CHGMMOccupancyMap>(lit_room::map());
    const mrpt::maps::CMetricMap& base = *map;
    const auto& neighbours = neighboursOf(base);
    neighbours.nn_prepare_for_3d_queries();
    const auto cloud = lit_room::scan({0.2, -0.1, 0.1}, 9)->pointcloud;
    const Eigen::Vector3d at = lit_room::kMiddle_map + Eigen::Vector3d(0.2, -0.1, 0.1);
    const CPose3D truth(at.x(), at.y(), at.z(), 0, 0, 0);
    CPose3D pose = truth + CPose3D(0.2, -0.15, 0.2, 0.06, -0.04, 0.05);
    for (int iteration = 0; iteration < 40; ++iteration) {
        std::map<std::uint64_t, std::pair<float, mrpt::tfest::TMatchingPair>> best;
        for (std::size_t i = 0; i < cloud->size(); ++i) {
            float x = 0, y = 0, z = 0, squared = 0;
            cloud->getPoint(i, x, y, z);
            const auto p = pose.composePoint(mrpt::math::TPoint3D(x, y, z));
            mrpt::math::TPoint3Df found;
            std::uint64_t index = 0;
            if (!neighbours.nn_single_search(mrpt::math::TPoint3Df(p), found, squared,
                                             index) ||
                squared > 0.25F)
                continue;
            const auto known = best.find(index);
            if (known == best.end() || squared < known->second.first)
                best[index] = {squared,
                               {std::uint32_t(index), std::uint32_t(i), found.x, found.y,
                                found.z, x, y, z}};
        }
        mrpt::tfest::TMatchingPairList pairs;
        for (const auto& entry : best) pairs.push_back(entry.second.second);
        mrpt::poses::CPose3DQuat better;
        double scale = 1;
        ASSERT_TRUE(mrpt::tfest::se3_l2(pairs, better, scale, true));
        pose = CPose3D(better);
    }
    const CPose3D error = pose - truth;
    EXPECT_LT(error.norm(), 0.02) << error;
    EXPECT_LT(std::abs(error.yaw()) + std::abs(error.pitch()) + std::abs(error.roll()),
              mrpt::DEG2RAD(0.6))
        << error;
}

}  // namespace
