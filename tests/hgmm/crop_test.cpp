#include <gtest/gtest.h>

#include <array>
#include <limits>
#include <random>
#include <string>
#include <vector>

#include "hgmm/map.h"
#include "room_scanner.h"

namespace hgmm {
namespace {

using Eigen::Vector3d;
using Box3 = Eigen::AlignedBox3d;

/// Where the room is in the map [m].
const Vector3d kPlace(700, -300, 20);

Map makeRoom(bool withWarmth) {
    MapParams params;
    if (withWarmth) params.modalities = {"warm"};
    Map map(params);
    for (int i = 0; i < 4; ++i) {
        Scan scan = testing::RoomScanner().scan(
            testing::poseAt(0.5 * i - 0.9, 0.2 * i, 1.2, 0.9 * i), 5 + i);
        if (withWarmth) {
            scan.channels.push_back({"warm", {}});
            for (std::size_t k = 0; k < scan.size(); ++k)
                scan.channels[0].values.push_back(0.5F +
                                                  0.1F * static_cast<float>(k % 7) / 7.F);
        }
        scan.T_map_sensor.t += kPlace;
        map.insert(scan);
    }
    return map;
}

const Map& scannedRoom() {
    static const Map map = makeRoom(false);
    return map;
}

const Map& warmRoom() {
    static const Map map = makeRoom(true);
    return map;
}

std::array<float, 5> numbersOf(const Occupancy& o) {
    return {o.occupied, o.free, o.unknown, o.alongRay_m, o.variance_m2};
}

Vector3d anyIn(const Box3& box, std::mt19937_64& random) {
    std::uniform_real_distribution<double> share(0.0, 1.0);
    Vector3d p;
    for (int d = 0; d < 3; ++d)
        p[d] = box.min()[d] + share(random) * (box.max()[d] - box.min()[d]);
    return p;
}

/// Points of a box, half of them on its faces or within 5 cm of them.
std::vector<Vector3d> pointsNearFaces(const Box3& box, std::size_t n) {
    std::mt19937_64 random(3);
    std::uniform_real_distribution<double> within(0.0, 0.05);
    std::vector<Vector3d> points;
    for (std::size_t i = 0; i < n; ++i) {
        Vector3d p = anyIn(box, random);
        const auto axis = static_cast<int>(i % 3);
        const double inside = i % 4 == 0 ? 0.0 : within(random);
        if (i % 2 == 0)
            p[axis] = i % 8 < 4 ? box.min()[axis] + inside : box.max()[axis] - inside;
        points.push_back(p);
    }
    return points;
}

const std::vector<Box3>& boxes() {
    static const std::vector<Box3> all = {
        {kPlace + Vector3d(-1.3, -4, -1), kPlace + Vector3d(0.7, 0.4, 3)},
        {kPlace + Vector3d(1.9, 0.3, 0.4), kPlace + Vector3d(4.1, 2.7, 1.7)},
        {kPlace + Vector3d(-4.3, -3.3, -0.3), kPlace + Vector3d(4.3, 3.3, 2.8)}};
    return all;
}

TEST(Crop, AnswersInTheBoxAreThoseOfTheWholeMap) {
    const Map& whole = scannedRoom();
    for (const Box3& box : boxes()) {
        const Map part = whole.crop(box);
        int occupied = 0, free = 0, unknown = 0;
        for (const Vector3d& p : pointsNearFaces(box, 10000)) {
            const Occupancy there = whole.occupancy(p);
            ASSERT_EQ(numbersOf(part.occupancy(p)), numbersOf(there)) << p.transpose();
            occupied += there.occupied > 0.5F ? 1 : 0;
            free += there.free > 0.5F ? 1 : 0;
            unknown += there.unknown > 0.5F ? 1 : 0;
        }
        EXPECT_GT(occupied, 30);
        EXPECT_GT(free, 1000);
        EXPECT_GT(unknown, 30);
    }
}

TEST(Crop, KeepsThePartOnly) {
    const Map& whole = scannedRoom();
    const Map part = whole.crop(boxes()[1]);
    EXPECT_LT(part.mixture().size(), whole.mixture().size() / 2);
    EXPECT_LT(part.coverageBytes(), whole.coverageBytes() / 2);
    EXPECT_EQ(part.origin(), whole.origin());
    EXPECT_EQ(part.params(), whole.params());
    EXPECT_EQ(whole.crop({kPlace - Vector3d(9, 9, 9), kPlace + Vector3d(9, 9, 9)}), whole);
    const Vector3d far(1e4, 1e4, 1e4);
    const Map nothing = whole.crop({far, far + Vector3d::Ones()});
    EXPECT_TRUE(nothing.empty());
    EXPECT_EQ(nothing.freeMixture().size(), 0U);
    EXPECT_EQ(nothing.coverageBytes(), 0U);
}

TEST(Crop, DensitiesDifferByAConstant) {
    const Map& whole = scannedRoom();
    const Map part = whole.crop(boxes()[0]);
    const double constant =
        std::log(part.mixture().totalSupport()) - std::log(whole.mixture().totalSupport());
    int known = 0;
    for (const Vector3d& p : pointsNearFaces(boxes()[0], 2000)) {
        const double there = whole.logDensity(p);
        if (!std::isfinite(there)) {
            EXPECT_EQ(part.logDensity(p), there);
            continue;
        }
        ++known;
        EXPECT_NEAR(part.logDensity(p) + constant, there, 1e-9);
    }
    EXPECT_GT(known, 500);
}

TEST(Crop, DistancesAreRightUpToTheFaces) {
    const Map& whole = scannedRoom();
    const Box3 box = boxes()[0];
    const Map part = whole.crop(box);
    int near = 0;
    for (const Vector3d& p : pointsNearFaces(box, 2000)) {
        const double toFace =
            std::min((p - box.min()).minCoeff(), (box.max() - p).minCoeff());
        const SurfaceDistance there = whole.distance(p);
        if (there.distance_m > toFace) {
            EXPECT_GE(part.distance(p).distance_m, there.distance_m);
            continue;
        }
        ++near;
        const SurfaceDistance here = part.distance(p);
        EXPECT_EQ(here.distance_m, there.distance_m);
        EXPECT_EQ(here.gradient, there.gradient);
        EXPECT_EQ(here.std_m, there.std_m);
    }
    EXPECT_GT(near, 100);
}

TEST(Crop, ModalitiesAreThoseOfTheWholeMapWhereTheyAreKnown) {
    const Map& whole = warmRoom();
    int known = 0;
    for (const Box3& box : boxes()) {
        const Map part = whole.crop(box);
        for (const Vector3d& p : pointsNearFaces(box, 4000)) {
            const ModalityEstimate here = part.modality("warm", p),
                                   there = whole.modality("warm", p);
            ASSERT_EQ(here.known, there.known);
            if (!there.known) continue;
            ++known;
            EXPECT_EQ(here.mean, there.mean);
            EXPECT_EQ(here.variance, there.variance);
        }
    }
    EXPECT_GT(known, 200);
    const Vector3d far(1e4, 1e4, 1e4);
    const Map nothing = whole.crop({far, far + Vector3d::Ones()});
    EXPECT_FALSE(nothing.modality("warm", far).known);
}

/// What a crop is for: tiles that are saved, and merged later.
TEST(Crop, CropsOfTwoMapsMergeAsTheMapsDo) {
    const Map& first = scannedRoom();
    Map second;
    for (int i = 0; i < 3; ++i) {
        Scan scan = testing::RoomScanner().scan(
            testing::poseAt(0.4 * i, 0.5 - 0.3 * i, 1.2, 0.4 * i), 50 + i);
        scan.T_map_sensor.t += kPlace;
        second.insert(scan);
    }
    Map whole = first;
    whole.merge(second);
    const Box3 box = boxes()[1];
    const Box3 grown(box.min() - Vector3d::Constant(1.5),
                     box.max() + Vector3d::Constant(1.5));
    Map part = first.crop(grown);
    part.merge(second.crop(grown));
    EXPECT_LT(part.mixture().size(), whole.mixture().size());
    for (const Vector3d& p : pointsNearFaces(box, 4000))
        ASSERT_EQ(numbersOf(part.occupancy(p)), numbersOf(whole.occupancy(p)))
            << p.transpose();
}

TEST(Crop, ASavedCropIsLoadedAsItWas) {
    const Map part = warmRoom().crop(boxes()[0]);
    const std::vector<std::uint8_t> exact = part.save(Encoding::exact);
    EXPECT_EQ(Map::load(exact.data(), exact.size()), part);
    const std::vector<std::uint8_t> compact = part.save();
    EXPECT_EQ(Map::load(compact.data(), compact.size()).save(), compact);
}

TEST(Crop, ABadBoxIsRefused) {
    const Map& map = scannedRoom();
    const double nan = std::numeric_limits<double>::quiet_NaN();
    const double inf = std::numeric_limits<double>::infinity();
    const Vector3d low(-1, -1, -1), high(1, 1, 1);
    EXPECT_THROW(map.crop({high, low}), std::invalid_argument);
    EXPECT_THROW(map.crop({Vector3d(nan, -1, -1), high}), std::invalid_argument);
    EXPECT_THROW(map.crop({low, Vector3d(1, inf, 1)}), std::invalid_argument);
    EXPECT_THROW(map.crop(Box3()), std::invalid_argument);
    EXPECT_TRUE(Map().crop({low, high}).empty());
}

}  // namespace
}  // namespace hgmm
