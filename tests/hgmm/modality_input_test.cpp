#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "coloured_scenes.h"

namespace hgmm {
namespace {

using testing::mapOf;
using testing::modelling;
using testing::paintedWall;
using testing::plain;

constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();

TEST(ModalityInput, NamesAreChecked) {
    EXPECT_NO_THROW(Map(modelling({"r", "g", "b", "intensity", "e", "f", "h", "i"})));
    EXPECT_THROW(Map(modelling({"r", "g", "b", "d", "e", "f", "h", "i", "j"})),
                 std::invalid_argument);
    EXPECT_THROW(Map(modelling({"r", ""})), std::invalid_argument);
    EXPECT_THROW(Map(modelling({"r", "g", "r"})), std::invalid_argument);
    MapParams params;
    params.modality.modalityUnexplained = 0;
    EXPECT_THROW(Map{params}, std::invalid_argument);
}

TEST(ModalityInput, PlacesWithoutAValueAreNotKnown) {
    Scan scan = paintedWall({{"r", plain(0.25)}, {"g", plain(0.5)}});
    for (std::size_t i = 0; i < scan.size(); ++i)
        if (scan.y[i] > 0) scan.channels[0].values[i] = i % 2 == 0 ? kNaN : HUGE_VALF;
    const Map map = mapOf(scan, {"r", "g"});
    EXPECT_TRUE(map.modality("r", {2, -0.3, 0}).known);
    EXPECT_FALSE(map.modality("r", {2, 0.4, 0}).known);
    EXPECT_TRUE(map.modality("g", {2, 0.4, 0}).known);
    EXPECT_NEAR(map.modality("r", {2, -0.3, 0}).mean, 0.25, 1e-3);
    EXPECT_NEAR(map.modality("r")->mixture().totalSupport(), 240 * 160 / 2.0, 1);
}

TEST(ModalityInput, AChannelThatWasNeverMeasuredHasNoModel) {
    Scan scan = paintedWall({{"r", plain(0.25)}, {"g", plain(0.5)}});
    for (float& v : scan.channels[1].values) v = kNaN;
    const Map map = mapOf(scan, {"r", "g", "b"});
    EXPECT_NE(map.modality("r"), nullptr);
    EXPECT_EQ(map.modality("g"), nullptr);
    EXPECT_EQ(map.modality("b"), nullptr);
    const ModalityEstimate nothing = map.modality("b", {2, 0, 0});
    EXPECT_FALSE(nothing.known);
    EXPECT_EQ(nothing.mean, 0);
}

TEST(ModalityInput, ScansMayLackChannels) {
    Map map(modelling({"r", "g"}));
    map.insert(paintedWall({{"r", plain(0.2)}, {"g", plain(0.8)}}, 1));
    map.insert(paintedWall({{"r", plain(0.4)}}, 2));
    map.insert(paintedWall({}, 3));
    map.insert(paintedWall({{"g", plain(0.6)}, {"unheard", plain(9)}}, 4));
    map.insert(paintedWall({{"r", plain(0.3)}, {"g", plain(0.7)}}, 5));
    EXPECT_NEAR(map.modality("r", {2, 0.1, 0}).mean, 0.3, 1e-2);
    EXPECT_NEAR(map.modality("g", {2, 0.1, 0}).mean, 0.7, 1e-2);
    for (const char* name : {"r", "g"})
        EXPECT_NEAR(map.modality(name)->mixture().totalSupport(), 3 * 240 * 160, 1);
    EXPECT_EQ(map.modality("unheard"), nullptr);
}

/// A user's channel in kelvin: floats must keep hundredths of a degree.
TEST(ModalityInput, ValuesNeedNotLieBetweenZeroAndOne) {
    MapParams params = modelling({"kelvin", "below"});
    const auto warm = [](double y, double) { return 295.0 + 2 * y; };
    Map map(params);
    map.insert(paintedWall({{"kelvin", warm}, {"below", plain(-3)}}));
    EXPECT_NEAR(map.modality("kelvin", {2, 0.3, 0}).mean, 295.6, 0.02);
    EXPECT_LT(map.modality("kelvin", {2, 0.3, 0}).variance, 0.01);
    EXPECT_NEAR(map.modality("below", {2, 0.3, 0}).mean, -3, 0.02);
}

TEST(ModalityInput, UnusableScansChangeNothing) {
    Map map(modelling({"r"}));
    Scan bad = paintedWall({{"r", plain(0.5)}});
    bad.channels[0].values.pop_back();
    EXPECT_THROW(map.insert(bad), std::invalid_argument);
    Scan nowhere = paintedWall({{"r", plain(0.5)}});
    nowhere.T_map_sensor.t.x() = 1000;
    for (float& x : nowhere.x) x = kNaN;
    map.insert(nowhere);
    EXPECT_TRUE(map == Map(modelling({"r"})));
    Scan one;
    one.pushBack(1, 0, 0);
    one.channels.push_back({"r", {0.5F}});
    map.insert(one);
    EXPECT_NEAR(map.modality("r", {1, 0, 0}).mean, 0.5, 1e-6);
    EXPECT_NO_THROW(map.modality("r")->mixture().check());
}

}  // namespace
}  // namespace hgmm
