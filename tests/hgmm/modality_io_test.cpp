#include <gtest/gtest.h>

#include <cstring>
#include <thread>
#include <vector>

#include "coloured_scenes.h"

namespace hgmm {
namespace {

using testing::modelling;
using testing::paintedWall;
using testing::patches;
using testing::plain;

Map colouredMap() {
    Map map(modelling({"r", "g", "intensity", "unseen"}));
    Scan scan = paintedWall({{"r", patches({0.1, 0.9, 0.4})},
                             {"g", [](double y, double z) { return 0.5 + 0.4 * y * z; }}});
    scan.T_map_sensor.t += Eigen::Vector3d(1000, 2000, 30);
    map.insert(scan);
    Scan grey = paintedWall({{"intensity", patches({10, 80})}}, 2);
    grey.T_map_sensor = scan.T_map_sensor;
    map.insert(grey);
    return map;
}

Map loadedAgain(const Map& map, Encoding encoding) {
    const auto buffer = map.save(encoding);
    return Map::load(buffer.data(), buffer.size());
}

std::uint32_t versionOf(const std::vector<std::uint8_t>& buffer) {
    std::uint32_t version = 0;
    std::memcpy(&version, buffer.data() + 4, sizeof(version));
    return version;
}

TEST(ModalityIo, ExactRoundTripIsExact) {
    const Map map = colouredMap();
    const Map loaded = loadedAgain(map, Encoding::exact);
    EXPECT_TRUE(loaded == map);
    EXPECT_EQ(loaded.modalities(), map.modalities());
    EXPECT_EQ(loaded.modality("unseen"), nullptr);
    const Eigen::Vector3d p(1002, 2000.3, 30.1);
    EXPECT_EQ(loaded.modality("g", p).mean, map.modality("g", p).mean);
    EXPECT_EQ(loaded.modality("g", p).variance, map.modality("g", p).variance);
    EXPECT_TRUE(loaded.modality("r")->mixture(2) == map.modality("r")->mixture(2));
}

TEST(ModalityIo, CompactRoundTripIsCloseAndGivesTheSameBuffer) {
    const Map map = colouredMap();
    const auto buffer = map.save();
    const Map loaded = Map::load(buffer.data(), buffer.size());
    EXPECT_TRUE(loaded.save() == buffer);
    for (double y = -0.55; y < 0.56; y += 0.01) {
        const Eigen::Vector3d p(1002, 2000 + y, 30.1);
        ASSERT_EQ(loaded.modality("r", p).known, map.modality("r", p).known);
        EXPECT_NEAR(loaded.modality("g", p).mean, map.modality("g", p).mean, 0.01);
        EXPECT_NEAR(loaded.modality("intensity", p).mean, map.modality("intensity", p).mean,
                    4.0);
    }
    const std::size_t components = map.modality("r")->size();
    EXPECT_LE(map.modality("r")->savedBytes() + map.modality("g")->savedBytes(),
              29 * components + 200);
}

TEST(ModalityIo, CopiesAreEqualAndIndependent) {
    Map map = colouredMap();
    const Map copy = map;
    EXPECT_TRUE(copy == map);
    const Eigen::Vector3d p(1002, 2000.3, 30.1);
    const double before = copy.modality("intensity", p).mean;
    Scan scan = paintedWall({{"intensity", plain(200)}}, 3);
    scan.T_map_sensor.t = Eigen::Vector3d(1000, 2000, 30);
    map.insert(scan);
    EXPECT_FALSE(copy == map);
    EXPECT_EQ(copy.modality("intensity", p).mean, before);
    EXPECT_GT(map.modality("intensity", p).mean, before + 20);
    const Map moved = std::move(map);
    EXPECT_GT(moved.modality("intensity", p).mean, before + 20);
}

/// What a copy derives is made by the first of several readers.
TEST(ModalityIo, AFreshCopyMayBeAskedByManyThreads) {
    const Map map = colouredMap();
    const Eigen::Vector3d p(1002, 2000.3, 30.1);
    const double mean = map.modality("g", p).mean,
                 inferred = map.infer("g", {{"r", 0.9}}).mean;
    for (int round = 0; round < 5; ++round) {
        const Map copy = map;
        std::vector<std::thread> readers;
        std::vector<double> means(4), inferences(4);
        for (std::size_t k = 0; k < 4; ++k)
            readers.emplace_back([&, k] {
                inferences[k] = copy.infer("g", {{"r", 0.9}}).mean;
                means[k] = copy.modality("g", p).mean;
            });
        for (std::thread& reader : readers) reader.join();
        EXPECT_EQ(means, std::vector<double>(4, mean));
        EXPECT_EQ(inferences, std::vector<double>(4, inferred));
    }
}

TEST(ModalityIo, AllMapsAreSavedInTheNewestVersion) {
    Map map;
    map.insert(paintedWall({{"r", plain(0.5)}}));
    EXPECT_EQ(versionOf(map.save()), 4U);
    EXPECT_EQ(versionOf(colouredMap().save()), 4U);
}

TEST(ModalityIo, ParametersAreKept) {
    MapParams params = modelling({"b", "a"});
    params.modality.modalityUnexplained = 0.11;
    params.modality.modalityNoise = 0.3;
    const Map loaded = loadedAgain(Map(params), Encoding::compact);
    EXPECT_EQ(loaded.modalities(), params.modalities);
    EXPECT_EQ(loaded.params().modality.modalityUnexplained, 0.11);
    EXPECT_FALSE(loaded == Map(modelling({"a", "b"})));
}

TEST(ModalityIo, DamagedBuffersAreRefused) {
    const auto whole = colouredMap().save();
    for (std::size_t size = 0; size < whole.size(); size += 1 + size / 50)
        EXPECT_THROW(Map::load(whole.data(), size), FormatError);
    auto flipped = whole;
    flipped[whole.size() - 9] ^= 1U;
    EXPECT_THROW(Map::load(flipped.data(), flipped.size()), FormatError);
}

}  // namespace
}  // namespace hgmm
