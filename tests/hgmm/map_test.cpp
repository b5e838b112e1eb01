#include "hgmm/map.h"

#include <gtest/gtest.h>
#include <omp.h>

#include <cmath>
#include <limits>
#include <memory>
#include <thread>

#include "room_scanner.h"

namespace hgmm {
namespace {

using testing::poseAt;
using testing::RoomScanner;

Map roomMap(int scans = 6, const MapParams& params = {}) {
    Map map(params);
    for (int i = 0; i < scans; ++i)
        map.insert(RoomScanner().scan(
            poseAt(0.5 * i - 1.5, 0.2 * i, 1.0 + 0.05 * i, 0.4 * i), 10 + i));
    return map;
}

TEST(Map, ModelsTheRoom) {
    const Map map = roomMap();
    map.mixture().check();
    // Every point counts, up to the few components that rays seem to pass or that are too
    // thick.
    const double points = 6 * 360 * 32;
    EXPECT_NEAR(map.mixture().totalSupport(), points, 1e-3 * points);
    MapParams trusting;
    trusting.carving.carvedSupport = 1.0;
    trusting.carving.minSupport = 0;
    trusting.novelty.maxThickness = 1000;
    EXPECT_NEAR(roomMap(6, trusting).mixture().totalSupport(), points, 0.5);
    const RoomScanner room;
    // Points on the walls are likely, points 20 cm off them are not.
    std::size_t onSurface = 0, offSurface = 0, rays = 0;
    const Scan probe = room.scan(poseAt(0.1, 0.1, 1.3), 99);
    for (std::size_t i = 0; i < probe.size(); i += 7, ++rays) {
        const Eigen::Vector3d ray(probe.x[i], probe.y[i], probe.z[i]);
        const Eigen::Vector3d hit = ray + probe.T_map_sensor.t;
        const Eigen::Vector3d before = hit - 0.2 * ray.normalized();
        onSurface += map.logDensity(hit) > -8;
        offSurface += map.logDensity(before) > -8;
    }
    EXPECT_GT(double(onSurface), 0.97 * double(rays));
    EXPECT_LT(double(offSurface), 0.10 * double(rays));
}

TEST(Map, LevelsShrinkAndKeepTheSupport) {
    const Map map = roomMap();
    ASSERT_EQ(map.levelCount(), 5U);
    for (std::size_t l = 1; l < map.levelCount(); ++l) {
        EXPECT_LE(map.mixture(l).size(), map.mixture(l - 1).size());
        EXPECT_NEAR(map.mixture(l).totalSupport(), map.mixture().totalSupport(), 1.0);
    }
    EXPECT_LT(map.mixture(4).size(), map.mixture(0).size());
    EXPECT_THROW(map.mixture(5), std::out_of_range);
}

TEST(Map, LevelsAreTheSameHoweverOftenAsked) {
    Map asked, notAsked;
    for (int i = 0; i < 5; ++i) {
        const Scan scan = RoomScanner().scan(poseAt(0.4 * i, 0.1 * i, 1, 0.3 * i), 20 + i);
        asked.insert(scan);
        asked.mixture(2);
        notAsked.insert(scan);
    }
    for (std::size_t l = 0; l < asked.levelCount(); ++l)
        EXPECT_EQ(asked.mixture(l), notAsked.mixture(l));
}

TEST(Map, IsTheSameForAnyNumberOfThreads) {
    omp_set_num_threads(1);
    const auto serial = roomMap().save();
    omp_set_num_threads(2);
    const auto two = roomMap().save();
    omp_set_num_threads(5);
    const auto five = roomMap().save();
    EXPECT_EQ(serial, two);
    EXPECT_EQ(serial, five);
}

TEST(Map, FarFromTheOriginIsAsExactAsAtIt) {
    const Eigen::Vector3d far(1e5, -1e5, 2e3);
    Map here, there;
    for (int i = 0; i < 4; ++i) {
        Scan scan = RoomScanner().scan(poseAt(0.25 * i, 0.125 * i, 1.0, 0.5 * i), 30 + i);
        here.insert(scan);
        scan.T_map_sensor.t += far;
        there.insert(scan);
    }
    ASSERT_EQ(here.mixture().size(), there.mixture().size());
    EXPECT_EQ(there.origin(), here.origin() + far);
    for (std::size_t i = 0; i < here.mixture().size(); ++i) {
        const Gaussian<3> a = here.mixture()[i], b = there.mixture()[i];
        EXPECT_LT((a.mean - b.mean).norm(), 1e-6);
        EXPECT_TRUE(a.covariance.isApprox(b.covariance, 1e-4));
        const Eigen::Vector3d point = here.origin() + Eigen::Vector3d(a.mean);
        EXPECT_NEAR(here.logDensity(point), there.logDensity(point + far), 1e-4);
    }
}

TEST(Map, HostileScansLoseNothing) {
    Map map = roomMap(2);
    const auto before = map.save();
    const float nan = std::numeric_limits<float>::quiet_NaN();

    EXPECT_EQ(map.insert(Scan()).samples, 0U);
    Scan useless;
    useless.pushBack(nan, 0, 0);
    useless.pushBack(0, 0, 0);
    useless.pushBack(0.01F, 0, 0);
    const InsertReport report = map.insert(useless);
    EXPECT_EQ(report.points.notFinite, 1U);
    EXPECT_EQ(report.points.tooNear, 2U);
    EXPECT_EQ(map.save(), before);

    Scan torn = useless;
    torn.x.pop_back();
    EXPECT_THROW(map.insert(torn), std::invalid_argument);
    Scan badPose = RoomScanner().scan(poseAt(0, 0, 1), 1);
    badPose.T_map_sensor.t.x() = nan;
    EXPECT_THROW(map.insert(badPose), std::invalid_argument);
    badPose.T_map_sensor = poseAt(0, 0, 1);
    badPose.T_map_sensor.R *= 2;
    EXPECT_THROW(map.insert(badPose), std::invalid_argument);
    Scan badChannel = RoomScanner().scan(poseAt(0, 0, 1), 1);
    badChannel.channels.push_back({"intensity", {0.5F}});
    EXPECT_THROW(map.insert(badChannel), std::invalid_argument);
    EXPECT_EQ(map.save(), before);
}

TEST(Map, DegenerateScansGiveValidMaps) {
    const auto point = [](int kind, int i) -> Eigen::Vector3f {
        const float a = 0.01F * float(i % 40), b = 0.01F * float(i / 40);
        switch (kind) {
            case 0:
                return {2.F, 1.F, 0.5F};  // identical
            case 1:
                return {2.F, 1.F + a + b, 0.5F};  // on a line
            case 2:
                return {2.F, 1.F + a, 0.5F + b};  // on a plane
            default:
                return {float(1 + 50 * i), 0, 0};  // one by one, ever farther
        }
    };
    for (int kind = 0; kind < 4; ++kind) {
        Map map;
        Scan scan;
        for (int i = 0; i < 1000; ++i) {
            const Eigen::Vector3f p = point(kind, i);
            scan.pushBack(p.x(), p.y(), p.z());
        }
        map.insert(scan);
        map.insert(scan);
        map.mixture().check();
        for (std::size_t l = 0; l < map.levelCount(); ++l) map.mixture(l).check();
        ASSERT_FALSE(map.empty());
        const Eigen::Vector3d at = map.origin() + Eigen::Vector3d(map.mixture()[0].mean);
        EXPECT_TRUE(std::isfinite(map.logDensity(at))) << "kind " << kind;
    }
    Map single;
    Scan one;
    one.pushBack(3, 0, 0);
    single.insert(one);
    EXPECT_EQ(single.mixture().size(), 1U);
    EXPECT_GT(single.logDensity({3, 0, 0}), 0.0);
}

TEST(Map, EmptyMapAnswers) {
    const Map map;
    EXPECT_TRUE(map.empty());
    EXPECT_EQ(map.logDensity({0, 0, 0}), -std::numeric_limits<double>::infinity());
    EXPECT_TRUE(map.mixture(3).empty());
}

TEST(Map, CopiesAreIndependent) {
    const Map original = roomMap(2);
    Map copy = original;
    EXPECT_EQ(copy, original);
    copy.insert(RoomScanner().scan(poseAt(1, 1, 1), 77));
    EXPECT_NE(copy, original);
    EXPECT_NE(copy.save(), original.save());
    copy = original;
    EXPECT_EQ(copy.save(), original.save());
    copy.clear();
    EXPECT_TRUE(copy.empty());
}

TEST(Map, SnapshotsAreReadyAndStayAsTheyWere) {
    Map map = roomMap(2);
    for (int k = 0; k < 3; ++k) {
        const std::shared_ptr<const Map> snapshot = map.snapshot();
        EXPECT_EQ(*snapshot, map);
        const auto buffer = snapshot->save();
        const std::size_t held = snapshot->liveBytes();
        map.insert(RoomScanner().scan(poseAt(1, 1, 1), 77 + k));
        const Map fresh = *snapshot;  // prepares everything itself
        for (double x = -3.9; x < 4; x += 0.13) {
            const Eigen::Vector3d p(x, 0.3 * x, 1.1);
            const Occupancy a = snapshot->occupancy(p), b = fresh.occupancy(p);
            EXPECT_EQ(a.occupied, b.occupied);
            EXPECT_EQ(a.free, b.free);
            EXPECT_EQ(a.alongRay_m, b.alongRay_m);
        }
        EXPECT_EQ(snapshot->liveBytes(), held);
        EXPECT_EQ(snapshot->save(), buffer);
    }
}

TEST(Map, ConcurrentReadersOfACopyAgree) {
    const Map original = roomMap(3);
    const Map copy = original;  // its index is not there yet: the threads race to build it
    const Eigen::Vector3d wall(3.99, 0.3, 1.1);
    const double expected = original.logDensity(wall);
    std::vector<double> density(4, 0.0);
    std::vector<std::size_t> size(4, 0);
    std::vector<std::thread> threads;
    for (std::size_t t = 0; t < 4; ++t)
        threads.emplace_back([&, t] {
            density[t] = copy.logDensity(wall);
            size[t] = copy.mixture(2).size();
        });
    for (std::thread& thread : threads) thread.join();
    for (std::size_t t = 0; t < 4; ++t) {
        EXPECT_NEAR(density[t], expected, 1e-9);
        EXPECT_EQ(size[t], original.mixture(2).size());
    }
}

TEST(Map, BadParametersAreRefused) {
    MapParams params;
    params.hierarchy.levels = 0;
    EXPECT_THROW(Map{params}, std::invalid_argument);
    Map map;
    EXPECT_THROW(map.setParams(params), std::invalid_argument);
    EXPECT_EQ(map.levelCount(), 5U);
}

}  // namespace
}  // namespace hgmm
