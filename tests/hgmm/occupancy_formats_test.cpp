#include <gtest/gtest.h>

#include <cstring>

#include "scenes.h"

namespace hgmm {
namespace {

using namespace testing;

/// The checksum of map_io.cpp, written down a second time: the format is a promise.
std::uint64_t checksum(const std::uint8_t* data, std::size_t size) {
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
    const std::uint64_t size = out.size(), sum = checksum(out.data() + 24, size - 24);
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
    EXPECT_FALSE(map.views()[0].known());
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

TEST(PerComponent, HasAFreeComponentPerSurfaceOnEachLevel) {
    const Map map = mapOf(emptyRoom(), 6, perComponentParams());
    for (std::size_t level = 0; level < map.levelCount(); ++level) {
        map.freeMixture(level).check();
        EXPECT_GT(map.mixture(level).size(), 5U);
        EXPECT_EQ(map.freeMixture(level).size(), map.mixture(level).size());
        EXPECT_EQ(map.views(level).size(), map.mixture(level).size());
    }
}

TEST(PerComponent, AnswersLikeAMap) {
    const Map map = mapOf(emptyRoom(), 6, perComponentParams());
    int occupied = 0, free = 0, all = 0;
    for (double y = -2; y <= 2; y += 0.1)
        for (double z = 0.6; z <= 1.9; z += 0.1, ++all) {
            const Occupancy on = map.occupancy({4, y, z}),
                            before = map.occupancy({2.5, y, z});
            for (const Occupancy& o : {on, before}) {
                EXPECT_NEAR(o.occupied + o.free + o.unknown, 1, 1e-6);
                EXPECT_TRUE(std::isfinite(o.distance_m) && o.variance_m2 >= 0);
            }
            occupied += on.occupied > before.occupied;
            free += before.free > 0.5F;
            EXPECT_GT(map.occupancy({9, y, z}).unknown, 0.99F);
        }
    EXPECT_GT(occupied, 0.95 * all);
    EXPECT_GT(free, 0.8 * all);
}

TEST(PerComponent, SavesAndLoads) {
    const Map map = mapOf(emptyRoom(), 4, perComponentParams());
    const auto exact = map.save(Encoding::exact), compact = map.save();
    EXPECT_TRUE(Map::load(exact.data(), exact.size()) == map);
    const Map loaded = Map::load(compact.data(), compact.size());
    EXPECT_EQ(loaded.params().occupancy.freeSpace.freeSpaceModel, 1);
    EXPECT_EQ(loaded.freeMixture().size(), map.freeMixture().size());
    EXPECT_TRUE(loaded.save() == compact);
    // A free component still belongs to its surface: its mean lies before it.
    for (std::size_t i = 0; i < loaded.mixture().size(); ++i) {
        const Eigen::Vector3d between = loaded.freeMixture()[i].mean.head<3>() -
                                        Eigen::Vector3d(loaded.mixture()[i].mean);
        EXPECT_GT(between.normalized().dot(loaded.views()[i].direction), 0.5) << i;
    }
}

TEST(PerComponent, AFilledMapKeepsItsModel) {
    Map map = mapOf(emptyRoom(), 1);
    EXPECT_THROW(map.setParams(perComponentParams()), std::invalid_argument);
    EXPECT_EQ(map.params().occupancy.freeSpace.freeSpaceModel, 0);
    map.clear();
    map.setParams(perComponentParams());
    MapParams params;
    params.occupancy.freeSpace.freeSpaceModel = 2;
    EXPECT_THROW(Map{params}, std::invalid_argument);
}

}  // namespace
}  // namespace hgmm
