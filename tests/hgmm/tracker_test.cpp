// A sensor that is followed through a room whose surfaces are known in closed form.
#include "hgmm/tracker.h"

#include <gtest/gtest.h>
#include <omp.h>

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <cmath>
#include <limits>
#include <memory>

#include "room_scanner.h"

namespace hgmm {
namespace {

using testing::poseAt;
using testing::RoomScanner;

constexpr double kPeriod_s = 0.1;

RoomScanner smallScanner() {
    RoomScanner scanner;
    scanner.azimuths = 120;
    scanner.elevations = 12;
    return scanner;
}

/// A walk along an arc, at 1 m/s and 0.5 rad/s; at k = 0 it is not at the origin.
Pose walk(int k) {
    const double yaw_rad = 0.05 * k;
    return poseAt(-1.0 + 2.0 * std::sin(yaw_rad), -1.5 + 2.0 * (1 - std::cos(yaw_rad)), 1.0,
                  yaw_rad);
}

double metresBetween(const Pose& a, const Pose& b) {
    return (a.t - b.t).norm();
}

double radiansBetween(const Pose& a, const Pose& b) {
    return Eigen::AngleAxisd(Eigen::Matrix3d(a.R * b.R.transpose())).angle();
}

PoseEstimate at(const Pose& T_map_sensor, double std = 1e-3) {
    PoseEstimate estimate;
    estimate.T_map_sensor = T_map_sensor;
    estimate.covariance = Registration::Covariance::Identity() * std * std;
    return estimate;
}

std::shared_ptr<Map> mapOfRoom(const RoomScanner& scanner) {
    auto map = std::make_shared<Map>();
    for (int k = 0; k < 16; k += 3) map->insert(scanner.scan(walk(k), 100 + k));
    return map;
}

TEST(ScanTracker, FollowsAWalkWithoutPoses) {
    const RoomScanner scanner = smallScanner();
    ScanTracker tracker({}, {}, at(walk(0)));
    for (int k = 0; k < 16; ++k) {
        const TrackedPose found = tracker.track(scanner.scan(walk(k), k), k * kPeriod_s);
        ASSERT_FALSE(found.lost) << k;
        EXPECT_LT(metresBetween(found.T_map_sensor, walk(k)), 0.03) << k;
        EXPECT_LT(radiansBetween(found.T_map_sensor, walk(k)), 0.01) << k;
    }
    EXPECT_FALSE(tracker.map().empty());
}

/// As a robot that is driven from one place to the next and stops to scan.
std::vector<Pose> wideSteps() {
    return {poseAt(-2.5, -1.5, 1, 0.1), poseAt(-1.0, -1.6, 1, 0.3),
            poseAt(0.4, -1.2, 1, 1.8),  poseAt(0.6, 0.3, 1, 3.1),
            poseAt(-0.8, 0.8, 1, -1.7), poseAt(-0.9, -0.9, 1, 0.2),
            poseAt(1.0, -0.6, 1, 0.9)};
}

TEST(ScanTracker, FollowsWideStepsAndLargeTurnsWithoutOdometry) {
    const RoomScanner scanner = smallScanner();
    const std::vector<Pose> truth = wideSteps();
    ScanTracker tracker({}, {}, at(truth[0]));
    for (std::size_t k = 0; k < truth.size(); ++k) {
        const TrackedPose found = tracker.track(scanner.scan(truth[k], k), 2.0 * double(k));
        ASSERT_FALSE(found.lost) << k;
        EXPECT_LT(metresBetween(found.T_map_sensor, truth[k]), 0.03) << k;
        EXPECT_LT(radiansBetween(found.T_map_sensor, truth[k]), 0.01) << k;
    }
}

TEST(ScanTracker, FindsItselfInAGivenMapFromAWrongStart) {
    const RoomScanner scanner = smallScanner();
    const auto map = mapOfRoom(scanner);
    Pose start = walk(0);
    start.t += Eigen::Vector3d(0.2, -0.15, 0.05);
    start.R = Eigen::AngleAxisd(0.1, Eigen::Vector3d::UnitZ()) * start.R;
    ScanTracker tracker(map, at(start, 0.2));
    const Map before = *map;
    for (int k = 0; k < 6; ++k) {
        const TrackedPose found = tracker.track(scanner.scan(walk(k), k), k * kPeriod_s);
        ASSERT_FALSE(found.lost) << k;
        EXPECT_FALSE(found.inserted);
        EXPECT_EQ(found.observable, 6);
        EXPECT_GT(found.overlap, 0.8);
        EXPECT_LT(metresBetween(found.T_map_sensor, walk(k)), 0.02) << k;
        EXPECT_LT(radiansBetween(found.T_map_sensor, walk(k)), 0.01) << k;
    }
    EXPECT_EQ(*map, before);
}

TEST(ScanTracker, TakesMotionOutOfAScan) {
    // Each elevation is measured from another pose, so that the scan as a whole is bent.
    RoomScanner line = smallScanner();
    const RoomScanner whole = line;
    const auto map = mapOfRoom(whole);
    const auto sweep = [&](int k) {
        Scan bent;
        std::vector<float> times;
        const Scan still = whole.scan(walk(k), 7);
        for (std::size_t i = 0; i < still.size(); ++i) {
            const float time_s =
                float(-kPeriod_s * (1.0 - double(i) / double(still.size())));
            const double yaw_rad = 0.05 * (k + double(time_s) / kPeriod_s);
            const Pose T =
                testing::poseAt(-1.0 + 2.0 * std::sin(yaw_rad),
                                -1.5 + 2.0 * (1 - std::cos(yaw_rad)), 1.0, yaw_rad);
            const Eigen::Vector3d u =
                Eigen::Vector3d(still.x[i], still.y[i], still.z[i]).normalized();
            const Eigen::Vector3d p = whole.range(T.t, T.R * u) * u;
            bent.pushBack(float(p.x()), float(p.y()), float(p.z()));
            times.push_back(time_s);
        }
        return std::pair(bent, times);
    };
    double withTimes_m = 0, without_m = 0;
    for (const bool timed : {true, false}) {
        ScanTracker tracker(map, at(walk(0), 0.05));
        for (int k = 0; k < 8; ++k) {
            const auto [scan, times] = sweep(k);
            const TrackedPose found = tracker.track(scan, k * kPeriod_s, {},
                                                    timed ? times : std::vector<float>());
            if (k < 3) continue;  // the velocity is learnt
            (timed ? withTimes_m : without_m) += metresBetween(found.T_map_sensor, walk(k));
        }
    }
    EXPECT_LT(withTimes_m / 5, 0.015);
    EXPECT_GT(without_m / 5, 2 * withTimes_m / 5);
}

/// A long straight corridor: floor, ceiling and two walls without end. Rings must be so
/// dense that they join: a single ring is a curve across the corridor.
RoomScanner corridor() {
    RoomScanner scanner = smallScanner();
    scanner.room = {Eigen::Vector3d(-300, -1, 0), Eigen::Vector3d(300, 1, 2.5)};
    scanner.furniture.clear();
    scanner.azimuths = 90;
    scanner.elevations = 40;
    return scanner;
}

TEST(ScanTracker, ACorridorLeavesTheWayAlongItToOdometry) {
    const RoomScanner scanner = corridor();
    MapParams mapParams;
    mapParams.filter.maxRange_m = 5;
    ScanTracker tracker(mapParams, {}, at(poseAt(0, 0, 1)));
    constexpr double kStep_m = 0.2, kOff = 1.1;  // odometry is wrong by 10 %
    MotionIncrement motion;
    motion.T_last_now.t = {kOff * kStep_m, 0, 0};
    motion.covariance = Registration::Covariance::Identity() * 0.02 * 0.02;
    TrackedPose found;
    constexpr int kScans = 10;
    for (int k = 0; k < kScans; ++k)
        found = tracker.track(scanner.scan(poseAt(k * kStep_m, 0, 1), k), k * kPeriod_s,
                              k > 0 ? std::optional(motion) : std::nullopt);
    EXPECT_EQ(found.observable, 5);
    const Pose& T = found.T_map_sensor;
    EXPECT_NEAR(T.t.x(), kOff * kStep_m * (kScans - 1), 0.02);
    EXPECT_NEAR(T.t.y(), 0.0, 0.02);
    EXPECT_NEAR(T.t.z(), 1.0, 0.02);
    // Along it variances of odometry add up.
    EXPECT_NEAR(std::sqrt(found.covariance(3, 3)), 0.02 * std::sqrt(kScans - 1.0), 0.01);
    EXPECT_LT(std::sqrt(found.covariance(4, 4)), 0.01);
}

/// As a corridor, but the rings are so far apart that they do not join, or there is but
/// one, of a planar laser: what is seen far along it is the pattern of the rays, which goes
/// with the sensor.
TEST(ScanTracker, ThePatternOfRaysDoesNotHoldASensorInACorridor) {
    for (const int rings : {1, 16}) {
        RoomScanner scanner = corridor();
        scanner.azimuths = rings == 1 ? 480 : 240;
        scanner.elevations = rings;
        scanner.elevationSpan_rad = rings == 1 ? 0.0 : 0.52;
        MapParams mapParams;
        mapParams.filter.maxRange_m = 50;
        ScanTracker tracker(mapParams, {}, at(poseAt(0, 0, 1)));
        MotionIncrement motion;
        motion.T_last_now.t = {0.15, 0, 0};
        motion.covariance = Registration::Covariance::Identity() * 0.02 * 0.02;
        TrackedPose found;
        constexpr int kScans = 20;
        for (int k = 0; k < kScans; ++k)
            found = tracker.track(scanner.scan(poseAt(k * 0.15, 0, 1), k), k * kPeriod_s,
                                  k > 0 ? std::optional(motion) : std::nullopt);
        EXPECT_NEAR(found.T_map_sensor.t.x(), 0.15 * (kScans - 1), 0.3) << rings;
        EXPECT_GT(std::sqrt(found.covariance(3, 3)), 0.02) << rings;
    }
}

TEST(ScanTracker, APlanarLaserStaysInItsPlane) {
    RoomScanner scanner = smallScanner();
    scanner.elevations = 1;
    scanner.elevationSpan_rad = 0;
    scanner.azimuths = 360;
    ScanTracker tracker({}, {}, at(walk(0)));
    for (int k = 0; k < 20; ++k) {
        const TrackedPose found = tracker.track(scanner.scan(walk(k), k), k * kPeriod_s);
        ASSERT_FALSE(found.lost) << k;
        EXPECT_LE(found.observable, 3);
        EXPECT_NEAR(found.T_map_sensor.t.z(), 1.0, 1e-6);
        EXPECT_NEAR(found.T_map_sensor.R(2, 2), 1.0, 1e-9);
        EXPECT_LT(metresBetween(found.T_map_sensor, walk(k)), 0.05) << k;
        EXPECT_LT(radiansBetween(found.T_map_sensor, walk(k)), 0.02) << k;
    }
}

TEST(ScanTracker, IsLostElsewhere) {
    const RoomScanner scanner = smallScanner();
    RoomScanner elsewhere = smallScanner();
    elsewhere.room = {Eigen::Vector3d(-15, -12, -3), Eigen::Vector3d(15, 12, 9)};
    elsewhere.furniture.clear();
    ScanTracker tracker(mapOfRoom(scanner), at(walk(0), 0.1));
    TrackedPose found;
    for (int k = 0; k < 3; ++k)
        found = tracker.track(elsewhere.scan(walk(k), k), k * kPeriod_s);
    EXPECT_TRUE(found.lost);
}

/// Odometry that leaves its map, here through a wall, begins anew instead of being lost for
/// ever.
TEST(ScanTracker, GoesOnWhereItsMapDoesNotReach) {
    const RoomScanner scanner = smallScanner();
    RoomScanner hall = scanner;
    hall.room = {Eigen::Vector3d(-15, -12, -3), Eigen::Vector3d(15, 12, 9)};
    hall.furniture.clear();
    ScanTracker tracker({}, {}, at(walk(0)));
    double time_s = 0;
    for (int k = 0; k < 5; ++k)
        tracker.track(scanner.scan(walk(k), k), time_s += kPeriod_s);
    const Pose far = poseAt(2, 3, 2, 0.3);
    int lost = 0;
    TrackedPose last;
    for (int k = 0; k < 12; ++k) {
        last = tracker.track(hall.scan(far, 50 + k), time_s += kPeriod_s);
        lost += last.lost ? 1 : 0;
    }
    EXPECT_GT(lost, 0);
    EXPECT_LT(lost, 8);
    EXPECT_FALSE(last.lost);
    EXPECT_GT(last.overlap, 0.5);
}

/// Odometry says that the sensor stands still while it is carried to a longer room, in
/// which it sees through the walls of the first one. Most of what it sees fits all the
/// same.
TEST(ScanTracker, ThatItWasCarriedAwayMakesTheNextMapAGuess) {
    const RoomScanner scanner = smallScanner();
    RoomScanner other = scanner;
    other.room = {Eigen::Vector3d(-9.0, -3.0, 0.0), Eigen::Vector3d(9.0, 3.0, 2.5)};
    ScanTracker tracker({}, {}, at(walk(0)));
    MotionIncrement still;
    double time_s = 0;
    TrackedPose found;
    for (int k = 0; k < 6; ++k)
        found = tracker.track(scanner.scan(walk(0), k), time_s += kPeriod_s, still);
    ASSERT_FALSE(found.lost);
    EXPECT_LT(found.covariance(3, 3), 1e-3);
    int lost = 0;
    bool hasBegunAnew = false;
    for (int k = 0; k < 8 && !hasBegunAnew; ++k) {
        found = tracker.track(other.scan(walk(0), 20 + k), time_s += kPeriod_s, still);
        lost += found.lost ? 1 : 0;
        hasBegunAnew = found.lost && found.inserted;
    }
    EXPECT_EQ(lost, 5);
    ASSERT_TRUE(hasBegunAnew);
    EXPECT_GT(std::sqrt(found.covariance(3, 3)), 0.5);
}

TEST(ScanTracker, CovariancesAreChecked) {
    PoseEstimate start;
    start.covariance(2, 2) = std::numeric_limits<double>::quiet_NaN();
    EXPECT_THROW(ScanTracker({}, {}, start), std::invalid_argument);
    start.covariance = -Registration::Covariance::Identity();
    EXPECT_THROW(ScanTracker({}, {}, start), std::invalid_argument);
    ScanTracker tracker;
    const Scan scan = smallScanner().scan(walk(0), 1);
    tracker.track(scan, 0);
    MotionIncrement odometry;
    odometry.covariance.setZero();
    EXPECT_THROW(tracker.track(scan, 1, odometry), std::invalid_argument);
    EXPECT_FALSE(tracker.track(scan, 1).lost);
}

TEST(ScanTracker, DoesNotDependOnThreads) {
    const RoomScanner scanner = smallScanner();
    const auto run = [&](int threads) {
        omp_set_num_threads(threads);
        ScanTracker tracker({}, {}, at(walk(0)));
        TrackedPose found;
        for (int k = 0; k < 5; ++k)
            found = tracker.track(scanner.scan(walk(k), k), k * kPeriod_s);
        const Pose far = poseAt(0.4, 0.3, 1.0, 2.0);  // searched for
        found = tracker.track(scanner.scan(far, 5), 5 * kPeriod_s);
        EXPECT_LT(metresBetween(found.T_map_sensor, far), 0.05);
        return found;
    };
    const int before = omp_get_max_threads();
    const TrackedPose once = run(1), again = run(3);
    omp_set_num_threads(before);
    EXPECT_EQ(once.T_map_sensor.t, again.T_map_sensor.t);
    EXPECT_EQ(once.T_map_sensor.R, again.T_map_sensor.R);
    EXPECT_EQ(once.covariance, again.covariance);
}

TEST(ScanTracker, BadInputIsRefusedAndChangesNothing) {
    const RoomScanner scanner = smallScanner();
    const Scan scan = scanner.scan(walk(0), 1);
    TrackerParams params;
    params.minOverlap = 2;
    EXPECT_THROW(ScanTracker(MapParams(), params), std::invalid_argument);
    EXPECT_THROW(ScanTracker(nullptr, PoseEstimate()), std::invalid_argument);
    EXPECT_THROW(ScanTracker(std::make_shared<Map>(), PoseEstimate()),
                 std::invalid_argument);

    ScanTracker tracker;
    tracker.track(scan, 5.0);
    const Map before = tracker.map();
    EXPECT_THROW(tracker.track(scan, 4.0), std::invalid_argument);
    EXPECT_THROW(tracker.track(scan, std::numeric_limits<double>::quiet_NaN()),
                 std::invalid_argument);
    EXPECT_THROW(tracker.track(scan, 6.0, {}, {0.F}), std::invalid_argument);
    MotionIncrement motion;
    motion.T_last_now.R *= 2;
    EXPECT_THROW(tracker.track(scan, 6.0, motion), std::invalid_argument);
    EXPECT_EQ(tracker.map(), before);
    // A scan without points says nothing.
    EXPECT_TRUE(tracker.track(Scan(), 6.0).lost);
}

}  // namespace
}  // namespace hgmm
