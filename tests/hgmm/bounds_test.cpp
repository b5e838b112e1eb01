#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>
#include <functional>

#include "index/box_index.h"
#include "io/checksum.h"
#include "scenes.h"

namespace hgmm {
namespace {

using testing::emptyRoom;
using testing::mapOf;
using testing::poseAt;
using testing::RoomScanner;

std::string refusalOf(const std::function<void()>& call) {
    try {
        call();
    } catch (const std::invalid_argument& e) {
        return e.what();
    }
    return "nothing was refused";
}

Scan smallScan(const Pose& T_map_sensor) {
    RoomScanner scanner = emptyRoom();
    scanner.azimuths = 60;
    scanner.elevations = 12;
    return scanner.scan(T_map_sensor, 1);
}

TEST(Bounds, AbsurdPosesAreRefusedAndChangeNothing) {
    Map map = mapOf(emptyRoom(), 1);
    const Map before(map);
    for (const double x : {1.1e8, -1e14, 1e20, 1e38, 1e300}) {
        Scan scan = smallScan(poseAt(0, 0, 1));
        scan.T_map_sensor.t.x() = x;
        EXPECT_NE(refusalOf([&] { map.insert(scan); }).find("1e8 m"), std::string::npos)
            << x;
        EXPECT_NE(refusalOf([&] { map.merge(before, scan.T_map_sensor); }).find("1e8 m"),
                  std::string::npos)
            << x;
    }
    EXPECT_TRUE(map == before);
}

TEST(Bounds, MapsAtTheLimitAnswerAndCannotBeMovedBeyondIt) {
    Map map;
    map.insert(smallScan(poseAt(1e8, -1e8, 0)));
    map.insert(smallScan(poseAt(-1e8, 1e8, 0)));
    EXPECT_TRUE(Map::load(map.save().data(), map.save().size()).save() == map.save());
    const Occupancy here = map.occupancy({1e8, -1e8, 0});
    EXPECT_NEAR(here.occupied + here.free + here.unknown, 1, 1e-6);
    Map other;
    EXPECT_NE(refusalOf([&] { other.merge(map, poseAt(1e3, 0, 0)); }).find("origin"),
              std::string::npos);
    EXPECT_TRUE(other == Map());
}

TEST(Bounds, AMapOfTheLimitStillKnowsWhereItWasMade) {
    Map map = mapOf(emptyRoom(), 2);
    const Occupancy before = map.occupancy({0, 0, 1});
    ASSERT_GT(before.free, 0.9F);
    map.insert(smallScan(poseAt(1e8, 0, 1)));
    EXPECT_EQ(map.occupancy({0, 0, 1}).free, before.free);
}

/// A saved map in which the first of some floats, found by what they are, is another.
std::vector<std::uint8_t> withFirst(const Map& map, const std::vector<float>& array,
                                    float value) {
    std::vector<std::uint8_t> buffer = map.save(Encoding::exact);
    const auto* bytes = reinterpret_cast<const std::uint8_t*>(array.data());
    const auto place = std::search(buffer.begin(), buffer.end(), bytes,
                                   bytes + array.size() * sizeof(float));
    EXPECT_NE(place, buffer.end());
    std::memcpy(&*place, &value, sizeof(value));
    constexpr std::size_t kHead = 24;
    const std::uint64_t sum = checksum(buffer.data() + kHead, buffer.size() - kHead);
    std::memcpy(&buffer[16], &sum, sizeof(sum));
    return buffer;
}

TEST(Bounds, BuffersWithHugeNumbersAreRefused) {
    const Map map = mapOf(emptyRoom(), 1);
    const Mixture<3>& base = map.mixture();
    const auto refuses = [&](const std::vector<float>& array, float value) {
        const auto buffer = withFirst(map, array, value);
        EXPECT_THROW(Map::load(buffer.data(), buffer.size()), FormatError) << value;
    };
    for (const float mean : {2e9F, -1e30F}) {
        refuses(base.mean[0], mean);
        refuses(map.freeMixture().mean[2], mean);
    }
    refuses(base.covariance[0], 1e20F);
    refuses(map.freeMixture().covariance[0], 1e20F);
    refuses(base.support, 1e20F);
    const auto sound = withFirst(map, base.mean[0], base.mean[0].front());
    EXPECT_TRUE(Map::load(sound.data(), sound.size()) == map);
}

TEST(Bounds, MergingAMapWithItselfForEverKeepsIt) {
    Map map;
    map.insert(smallScan(poseAt(0, 0, 1)));
    const std::size_t components = map.mixture().size();
    for (int k = 0; k < 300; ++k) map.merge(map);
    EXPECT_EQ(map.mixture().size(), components);
    const std::vector<float>& support = map.mixture().support;
    EXPECT_EQ(*std::max_element(support.begin(), support.end()), float(kMaxSupport));
    EXPECT_GT(map.occupancy({0, 0, 1}).free, 0.9F);
    const auto buffer = map.save();
    EXPECT_TRUE(Map::load(buffer.data(), buffer.size()).save() == buffer);
}

/// Free components keep to their cells, wherever the floats of their means lie.
TEST(Bounds, ExactCopiesAreEqualFarFromTheFirstScan) {
    for (const double far_m : {0.0, 3e3, 1e5}) {
        Map map = mapOf(emptyRoom(), 1);
        Map moved;
        moved.merge(map, testing::shaken(poseAt(far_m, -far_m, 0), 5, 1, 3));
        map.merge(moved, testing::shaken(poseAt(far_m, far_m, 0), 5, 1, 4));
        map.insert(smallScan(poseAt(far_m, 2 * far_m, 1)));
        const auto buffer = map.save(Encoding::exact);
        EXPECT_TRUE(Map::load(buffer.data(), buffer.size()) == map) << far_m;
        const auto compact = map.save();
        EXPECT_TRUE(Map::load(compact.data(), compact.size()).save() == compact) << far_m;
    }
}

std::vector<std::uint32_t> candidatesAt(const BoxIndex<3>& index, float v) {
    std::vector<std::uint32_t> found;
    index.visitCandidates(v, v, v, [&](std::uint32_t i) { found.push_back(i); });
    return found;
}

TEST(Bounds, BoxesAreFoundBeyondTheLastCells) {
    BoxIndex<3> index;
    const float centres[] = {-1048576.F, 1048576.F, -1e9F, 1e9F, 0.F};
    for (std::uint32_t i = 0; i < 5; ++i)
        index.add({{centres[i], centres[i], centres[i]}, {1e-4F, 1e-4F, 1e-4F}});
    for (std::uint32_t i = 0; i < 5; ++i) {
        const auto found = candidatesAt(index, centres[i]);
        EXPECT_EQ(std::count(found.begin(), found.end(), i), 1) << centres[i];
    }
}

TEST(Bounds, LargeBoxesTakeFewCells) {
    BoxIndex<3> index;
    index.add({{0, 0, 0}, {4e8F, 4e8F, 4e8F}});
    EXPECT_LT(index.liveBytes(), 100000U);
    EXPECT_EQ(candidatesAt(index, 3e8F).size(), 1U);
}

TEST(Bounds, LongRaysThroughSmallCellsEnd) {
    BoxIndex<3> index;
    index.add({{1e6F, 0, 0}, {1e-4F, 1e-4F, 1e-4F}});
    const float start[3] = {0, 0, 0}, direction[3] = {1, 0, 0};
    int met = 0;
    index.visitAlongRay(start, direction, 1e6F, [&](std::uint32_t) { ++met; });
    EXPECT_GT(met, 0);
}

}  // namespace
}  // namespace hgmm
