#include "hgmm/novelty.h"

#include <gtest/gtest.h>

#include <random>

#include "hgmm/filter.h"
#include "hgmm/map.h"
#include "room_scanner.h"

namespace hgmm {
namespace {

using testing::Box;
using testing::poseAt;
using testing::RoomScanner;

double novelShare(const InsertReport& report) {
    return double(report.novelSamples) / double(report.samples);
}

TEST(Novelty, AgreesWithADirectTest) {
    Map map;
    map.insert(RoomScanner().scan(poseAt(0, 0, 1), 1));
    const Mixture<3>& mixture = map.mixture();
    const Mixture<3> samples =
        transformed(filterScan(RoomScanner().scan(poseAt(0.4, 0.3, 1.2), 2), {}),
                    poseAt(0.4, 0.3, 0.2));
    ComponentIndex index;
    index.rebuild(mixture);
    NoveltyParams params;
    params.maxMahalanobis = 2.0;  // so that there are both kinds
    const NoveltySplit split = splitByNovelty(samples, index, params);
    ASSERT_EQ(split.novel.size() + split.known.size(), samples.size());
    EXPECT_GT(split.novel.size(), 10U);
    EXPECT_GT(split.known.size(), 10U);
    std::size_t k = 0;
    for (std::uint32_t i = 0; i < samples.size(); ++i) {
        const float p[3] = {samples.mean[0][i], samples.mean[1][i], samples.mean[2][i]};
        std::vector<std::uint32_t> near;
        for (std::uint32_t j = 0; j < mixture.size(); ++j)
            if (index.factor(j).squaredMahalanobis(p) <= 4.F) near.push_back(j);
        if (near.empty()) {
            EXPECT_TRUE(std::binary_search(split.novel.begin(), split.novel.end(), i));
            continue;
        }
        ASSERT_EQ(split.known.at(k), i);
        const auto& n = split.neighbourhoods;
        EXPECT_EQ(near, std::vector<std::uint32_t>(n.component.begin() + n.begin[k],
                                                   n.component.begin() + n.begin[k + 1]));
        ++k;
    }
}

TEST(Novelty, TheSameScanAgainAddsLittle) {
    Map map;
    const Scan scan = RoomScanner().scan(poseAt(0.3, -0.2, 1.0), 3);
    map.insert(scan);
    const std::size_t before = map.mixture().size();
    ASSERT_GT(before, 20U);
    const InsertReport again = map.insert(scan);
    EXPECT_LT(double(again.componentsAdded), 0.02 * double(before));
    const InsertReport otherNoise =
        map.insert(RoomScanner().scan(poseAt(0.3, -0.2, 1.0), 4));
    EXPECT_LT(double(otherNoise.componentsAdded), 0.02 * double(before));
    std::cout << "same scan again: +" << again.componentsAdded << " of " << before
              << " components; same place, new noise: +" << otherNoise.componentsAdded
              << "\n";
}

TEST(Novelty, ANewWallIsNovel) {
    const Box partition{Eigen::Vector3d(2.0, -1.5, 0.0), Eigen::Vector3d(2.1, 1.5, 2.0)};
    const RoomScanner before;
    RoomScanner after = before;
    after.furniture.push_back(partition);
    Map map;
    for (int i = 0; i < 4; ++i)
        map.insert(before.scan(poseAt(0.2 * i, 0.1 * i, 1.2), 50 + i));
    const Scan scan = after.scan(poseAt(0, 0, 1.2), 60);
    Scan wall;  // what that scan sees of the partition
    wall.T_map_sensor = scan.T_map_sensor;
    for (std::size_t i = 0; i < scan.size(); ++i)
        if (std::abs(scan.x[i] - 2.0F) < 0.03F && std::abs(scan.y[i]) < 1.5F)
            wall.pushBack(scan.x[i], scan.y[i], scan.z[i]);
    const InsertReport report = map.insert(wall);
    ASSERT_GT(report.samples, 100U);
    EXPECT_GE(novelShare(report), 0.98);
    std::cout << "new wall: " << 100 * novelShare(report) << " % novel\n";
}

TEST(Novelty, DoesNotDriftAsTheMapGrows) {
    // A thousand-fold support elsewhere shrinks every weight here, and must change nothing.
    const Scan here = RoomScanner().scan(poseAt(0, 0, 1), 7);
    RoomScanner elsewhere;
    Map small, large;
    small.insert(here);
    large.insert(here);
    for (int i = 1; i < 20; ++i) large.insert(elsewhere.scan(poseAt(0, 0, 1), 100 + i));
    Scan far = elsewhere.scan(poseAt(0, 0, 1), 50);
    far.T_map_sensor.t.x() += 200;
    for (int i = 0; i < 30; ++i) large.insert(far);
    const Scan probe = RoomScanner().scan(poseAt(0, 0, 1), 8);
    EXPECT_NEAR(novelShare(Map(small).insert(probe)), novelShare(Map(large).insert(probe)),
                0.02);
}

TEST(Novelty, ParametersOutOfRangeAreNamed) {
    NoveltyParams params;
    params.maxMahalanobis = ComponentIndex::kSigmas + 1;
    EXPECT_THROW(params.validate(), std::invalid_argument);
}

}  // namespace
}  // namespace hgmm
