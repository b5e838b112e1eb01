#include <gtest/gtest.h>

#include <fstream>
#include <iterator>
#include <string>
#include <vector>

#include <cstring>

#include "scenes.h"

namespace hgmm {
namespace {

using namespace testing;

/// The checksum of io/checksum.h, written down a second time: the format is a promise.
std::uint64_t promisedChecksum(const std::uint8_t* data, std::size_t size) {
    std::uint64_t h = 0xCBF29CE484222325ULL ^ size;
    for (std::size_t at = 0; at <= size; at += 8) {
        std::uint64_t word = 0;
        std::memcpy(&word, data + at, std::min<std::size_t>(8, size - at));
        h = (h ^ word) * 0x9E3779B97F4A7C15ULL;
        h ^= h >> 32U;
        if (size - at < 8) break;
    }
    return h;
}

template <typename T>
void put(std::vector<std::uint8_t>& out, const T& value) {
    const auto* p = reinterpret_cast<const std::uint8_t*>(&value);
    out.insert(out.end(), p, p + sizeof(T));
}

/// A buffer of format version 1: one parameter, an origin, components.
std::vector<std::uint8_t> versionOne(const Mixture<3>& surfaces,
                                     const Eigen::Vector3d& origin) {
    std::vector<std::uint8_t> out{'H', 'G', 'M', 'M'};
    put(out, std::uint32_t{1});
    put(out, std::uint64_t{0});
    put(out, std::uint64_t{0});
    put(out, std::uint32_t{2});
    for (const auto& [name, value] :
         {std::pair<std::string, double>{"levels", 3.0}, {"aFieldOfThatTime", 7.0}}) {
        out.push_back(static_cast<std::uint8_t>(name.size()));
        out.insert(out.end(), name.begin(), name.end());
        put(out, value);
    }
    for (int d = 0; d < 3; ++d) put(out, origin[d]);
    put(out, std::uint64_t{surfaces.size()});
    for (const float v : surfaces.support) put(out, v);
    for (const auto& axis : surfaces.mean)
        for (const float v : axis) put(out, v);
    for (const auto& entry : surfaces.covariance)
        for (const float v : entry) put(out, v);
    const std::uint64_t size = out.size(),
                        sum = promisedChecksum(out.data() + 24, size - 24);
    std::memcpy(out.data() + 8, &size, 8);
    std::memcpy(out.data() + 16, &sum, 8);
    return out;
}

TEST(OccupancyFormats, VersionOneLoadsAndAnswers) {
    const Map source = mapOf(emptyRoom(), 4);
    const Eigen::Vector3d origin(100, -200, 7);
    const auto buffer = versionOne(source.mixture(), origin);
    const Map map = Map::load(buffer.data(), buffer.size());
    EXPECT_EQ(map.levelCount(), 3U);
    EXPECT_EQ(map.origin(), origin);
    EXPECT_TRUE(map.mixture() == source.mixture());
    EXPECT_TRUE(map.freeMixture().empty());
    EXPECT_FALSE(map.viewDirections()[0].known());
    const Eigen::Vector3d shift = origin - source.origin();
    int occupied = 0, all = 0;
    for (double y = -2; y <= 2; y += 0.1)
        for (double z = 0.6; z <= 1.9; z += 0.1, ++all) {
            occupied += map.occupancy(shift + Eigen::Vector3d(4, y, z)).occupied > 0.5F;
            for (const double x : {2.0, 3.7, 4.5})
                EXPECT_GT(map.occupancy(shift + Eigen::Vector3d(x, y, z)).unknown, 0.9F);
        }
    EXPECT_GT(occupied, 0.95 * all);
    const auto hit = map.castRay(shift + Eigen::Vector3d(0, 0, 1), {1, 0.1, 0.1});
    ASSERT_TRUE(hit);
    EXPECT_NEAR(hit->point_map.x() - shift.x(), 4, 0.06);
    // It goes on as a map of today.
    const auto again = map.save(Encoding::exact);
    Map loaded = Map::load(again.data(), again.size());
    EXPECT_TRUE(loaded == map);
    Scan scan = emptyRoom().scan(walk(0), 9);
    Map fresh;
    fresh.insert(scan);
    scan.T_map_sensor.t += shift;
    loaded.insert(scan);
    int freeLoaded = 0, freeFresh = 0;
    for (double x = -2; x <= 2; x += 0.2)
        for (double y = -2; y <= 2; y += 0.2) {
            const Eigen::Vector3d p(x, y, 1);
            freeLoaded += loaded.occupancy(shift + p).free > 0.5F;
            freeFresh += fresh.occupancy(p).free > 0.5F;
        }
    EXPECT_GT(freeFresh, 100);
    EXPECT_GT(freeLoaded, 0.9 * freeFresh);
}

TEST(OccupancyFormats, VersionOneOfTheFutureAndOfNothingAreRefused) {
    auto buffer = versionOne(mapOf(emptyRoom(), 1).mixture(), {0, 0, 0});
    buffer[4] = 3;
    EXPECT_THROW(Map::load(buffer.data(), buffer.size()), FormatError);
    buffer[4] = 0;
    EXPECT_THROW(Map::load(buffer.data(), buffer.size()), FormatError);
    buffer[4] = 2;  // its content ends before the free space
    EXPECT_THROW(Map::load(buffer.data(), buffer.size()), FormatError);
}

TEST(OccupancyFormats, CompactMapsAnswerAsTheOriginal) {
    const Map map = mapOf(RoomScanner(), 8);
    const auto buffer = map.save();
    const Map loaded = Map::load(buffer.data(), buffer.size());
    int differ = 0, all = 0;
    for (double x = -3.95; x <= 4.05; x += 0.21)
        for (double y = -2.95; y <= 3.05; y += 0.19)
            for (double z = 0.05; z <= 2.5; z += 0.17, ++all) {
                const Occupancy a = map.occupancy({x, y, z}),
                                b = loaded.occupancy({x, y, z});
                differ += (a.occupied > 0.5F) != (b.occupied > 0.5F) ||
                          (a.free > 0.5F) != (b.free > 0.5F);
            }
    EXPECT_LT(differ, all / 200);
}

/// A map as it was saved while the thesis' own free space could be chosen.
TEST(OccupancyFormats, TheThesisOwnFreeSpaceIsRefusedInOneSentence) {
    std::ifstream file(HGMM_TEST_DATA "/thesis_free_space.bin", std::ios::binary);
    ASSERT_TRUE(file);
    const std::vector<std::uint8_t> buffer(std::istreambuf_iterator<char>(file), {});
    try {
        Map::load(buffer.data(), buffer.size());
        FAIL() << "it was loaded";
    } catch (const FormatError& e) {
        EXPECT_NE(std::string(e.what()).find("--study free-space"), std::string::npos)
            << e.what();
    }
}

}  // namespace
}  // namespace hgmm
