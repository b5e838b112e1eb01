#include <gtest/gtest.h>

#include <cstring>

#include "hgmm/map.h"
#include "room_scanner.h"

namespace hgmm {
namespace {

using testing::poseAt;
using testing::RoomScanner;

MapParams editedParams() {
    MapParams params;
    int k = 0;
    forEachNumber(params, [&](const OptionRow&, auto& member) {
        using Member = std::remove_reference_t<decltype(member)>;
        // Integers that are 0 choose between models: they stay.
        member = std::is_same_v<Member, int>
                     ? static_cast<Member>(member == 0 ? 0 : member + 1)
                     : static_cast<Member>(member * 0.99);
        ++k;
    });
    EXPECT_GT(k, 10);
    params.novelty.maxMahalanobis = 2.5;
    return params;
}

Map filledMap() {
    Map map(editedParams());
    Scan scan = RoomScanner().scan(poseAt(0, 0, 1), 1);
    scan.T_map_sensor.t += Eigen::Vector3d(1000, 2000, 30);
    map.insert(scan);
    return map;
}

Map reloaded(const Map& map, Encoding encoding) {
    const auto buffer = map.save(encoding);
    return Map::load(buffer.data(), buffer.size());
}

TEST(MapIo, ExactRoundTripIsExact) {
    const Map map = filledMap();
    ASSERT_GT(map.mixture().size(), 20U);
    ASSERT_GT(map.freeMixture().size(), 20U);
    const auto buffer = map.save(Encoding::exact);
    const Map loaded = Map::load(buffer.data(), buffer.size());
    EXPECT_TRUE(loaded == map);
    EXPECT_TRUE(loaded.save(Encoding::exact) == buffer);
    EXPECT_EQ(loaded.origin(), map.origin());
    const Eigen::Vector3d wall(1003.99, 2000.3, 31.1);
    EXPECT_EQ(loaded.logDensity(wall), map.logDensity(wall));
    EXPECT_TRUE(loaded.mixture(3) == map.mixture(3));
    EXPECT_TRUE(loaded.freeMixture(3) == map.freeMixture(3));
    EXPECT_TRUE(loaded.viewDirections(3) == map.viewDirections(3));
}

TEST(MapIo, CompactRoundTripGivesTheSameBuffer) {
    const Map map = filledMap();
    const auto buffer = map.save();
    EXPECT_LT(2 * buffer.size(), map.save(Encoding::exact).size());
    const Map loaded = Map::load(buffer.data(), buffer.size());
    EXPECT_TRUE(loaded.save() == buffer);
    EXPECT_TRUE(reloaded(loaded, Encoding::compact) == loaded);
    EXPECT_EQ(loaded.origin(), map.origin());
    EXPECT_EQ(loaded.mixture().size(), map.mixture().size());
    EXPECT_EQ(loaded.freeMixture().size(), map.freeMixture().size());
    const Eigen::Vector3d wall(1003.99, 2000.3, 31.1);
    EXPECT_NEAR(loaded.logDensity(wall), map.logDensity(wall), 0.1);
}

TEST(MapIo, ParametersSurvive) {
    const Map map = filledMap();
    for (const Encoding encoding : {Encoding::exact, Encoding::compact}) {
        const Map loaded = reloaded(map, encoding);
        std::vector<double> before, after;
        forEachNumber(map.params(), [&](auto&, const auto& v) { before.push_back(v); });
        forEachNumber(loaded.params(), [&](auto&, const auto& v) { after.push_back(v); });
        EXPECT_EQ(after, before);
        EXPECT_NE(loaded.params().filter.resolution_m, FilterParams().resolution_m);
    }
}

TEST(MapIo, MapsGoOnAfterLoading) {
    Map map = filledMap();
    Map loaded = reloaded(map, Encoding::exact);
    Map compact = reloaded(map, Encoding::compact);
    Scan next = RoomScanner().scan(poseAt(0.5, 0.2, 1.2, 0.7), 2);
    next.T_map_sensor.t += Eigen::Vector3d(1000, 2000, 30);
    map.insert(next);
    loaded.insert(next);
    compact.insert(next);
    // Index cells list components in another order after loading, which no answer may show.
    EXPECT_TRUE(loaded == map);
    EXPECT_TRUE(loaded.save() == map.save());
    EXPECT_NEAR(double(compact.mixture().size()), double(map.mixture().size()),
                0.05 * double(map.mixture().size()));
}

TEST(MapIo, EmptyMapRoundTrip) {
    const auto buffer = Map().save();
    EXPECT_EQ(Map::load(buffer.data(), buffer.size()), Map());
}

TEST(MapIo, EveryTruncationIsRefused) {
    const auto buffer = filledMap().save();
    for (std::size_t size = 0; size < buffer.size(); size += size < 600 ? 1 : 997)
        EXPECT_THROW(Map::load(buffer.data(), size), FormatError) << size;
}

TEST(MapIo, EveryFlippedByteIsRefused) {
    for (const Encoding encoding : {Encoding::exact, Encoding::compact}) {
        auto buffer = filledMap().save(encoding);
        for (std::size_t at = 0; at < buffer.size(); at += at < 600 ? 1 : 499) {
            buffer[at] ^= 0x10;
            EXPECT_THROW(Map::load(buffer.data(), buffer.size()), FormatError) << at;
            buffer[at] ^= 0x10;
        }
        EXPECT_TRUE(Map::load(buffer.data(), buffer.size()).save(encoding) == buffer);
    }
}

TEST(MapIo, ForeignAndNewerBuffersAreNamed) {
    const auto messageOf = [](const std::vector<std::uint8_t>& buffer) -> std::string {
        try {
            Map::load(buffer.data(), buffer.size());
        } catch (const FormatError& e) {
            return e.what();
        }
        return {};
    };
    auto buffer = filledMap().save();
    buffer.push_back(0);
    EXPECT_FALSE(messageOf(buffer).empty());
    buffer.pop_back();
    buffer[4] = 250;
    EXPECT_NE(messageOf(buffer).find("version 250"), std::string::npos);
    EXPECT_NE(messageOf({'P', 'C', 'D', ' ', 'x'}).find("not a saved HGMM map"),
              std::string::npos);
    EXPECT_THROW(Map::load(nullptr, 0), FormatError);
}

}  // namespace
}  // namespace hgmm
