#include "hgmm/evaluation/simulated_sensor.h"

#include <gtest/gtest.h>
#include <omp.h>

#include <cmath>

#include "hgmm/evaluation/planar_observation.h"
#include "hgmm/mrpt_bridge/observation_to_scan.h"

using namespace hgmm::evaluation;
using Eigen::Vector3d;

namespace {

constexpr double kDegree = M_PI / 180.0;

/// A wall whose face is at x = 4; nothing else.
Scene wall() {
    Scene scene;
    scene.add(Box{{4, -50, -50}, {5, 50, 50}}, Part::wall);
    return scene;
}

}  // namespace

TEST(SimulatedSensor, RaysOfEachKind) {
    const SimulatedSensor lidar = ringLidar(16, -15, 15, 900);
    ASSERT_EQ(lidar.directions_sensor.size(), 16U * 900U);
    EXPECT_NEAR(std::asin(lidar.directions_sensor.front().z()), -15 * kDegree, 1e-12);
    EXPECT_NEAR(std::asin(lidar.directions_sensor.back().z()), 15 * kDegree, 1e-12);
    EXPECT_NEAR(std::asin(lidar.directions_sensor[900].z()), -13 * kDegree, 1e-12);

    const SimulatedSensor camera = depthCamera(320, 240, 60);
    ASSERT_EQ(camera.directions_sensor.size(), 320U * 240U);
    const Vector3d& corner = camera.directions_sensor.front();  // left above
    // Half a pixel within the border of the image, at 30 deg and in proportion 4 : 3.
    EXPECT_NEAR(corner.y() / corner.x(), std::tan(30 * kDegree) * 319 / 320, 1e-12);
    EXPECT_NEAR(corner.z() / corner.y(), 239.0 / 319.0, 1e-12);

    const SimulatedSensor laser = planarLaser(541, 270);
    ASSERT_EQ(laser.directions_sensor.size(), 541U);
    EXPECT_NEAR((laser.directions_sensor[270] - Vector3d(1, 0, 0)).norm(), 0, 1e-12);
    const double s = std::sqrt(0.5);
    EXPECT_NEAR((laser.directions_sensor.front() - Vector3d(-s, -s, 0)).norm(), 0, 1e-12);
    for (const SimulatedSensor* sensor : {&lidar, &camera, &laser})
        for (const Vector3d& d : sensor->directions_sensor)
            ASSERT_NEAR(d.norm(), 1.0, 1e-12);
}

TEST(SimulatedSensor, PointsLieOnTheWallWithoutNoise) {
    const SimulatedSensor sensor = ringLidar(8, -20, 20, 90, 10.0);
    hgmm::Pose pose;  // turned by 90 deg, one metre before the wall's face
    pose.R << 0, -1, 0, 1, 0, 0, 0, 0, 1;
    pose.t << 3, 2, 1;
    const auto returns = simulateReturns(wall(), sensor, pose, {}, 1, 0);
    const hgmm::Scan scan = scanOf(returns, sensor, pose, WithoutReturn::clears);
    scan.validate();
    EXPECT_EQ(scan.size() + scan.clearedRays.size(), 8U * 90U);
    ASSERT_GT(scan.size(), 100U);
    for (std::size_t i = 0; i < scan.size(); ++i) {
        const Vector3d p = pose.R * Vector3d(scan.x[i], scan.y[i], scan.z[i]) + pose.t;
        ASSERT_NEAR(p.x(), 4.0, 1e-5);
        ASSERT_LE((p - pose.t).norm(), 10.0 + 1e-5);
    }
    for (const hgmm::ClearedRay& ray : scan.clearedRays) {
        ASSERT_EQ(ray.length_m, 10.0F);
        const Vector3d d = pose.R * ray.direction.cast<double>();
        ASSERT_TRUE(d.x() < 1e-6 || 1.0 / d.x() > 10.0 - 1e-5) << "it would have hit";
    }
    EXPECT_TRUE(scanOf(returns, sensor, pose, WithoutReturn::leftOut).clearedRays.empty());
}

TEST(SimulatedSensor, NoiseHasTheSpreadAskedForAndIsBoundToRayAndSeed) {
    const SimulatedSensor sensor = depthCamera(200, 100, 60, 100.0);
    RangeErrors errors;
    errors.noise_m = 0.02;
    const auto returns = simulateReturns(wall(), sensor, {}, errors, 7, 3);
    double sum = 0, squares = 0;
    for (const SimulatedReturn& r : returns) {
        ASSERT_TRUE(r.hit);
        const double error_m = r.range_m - r.truth.range_m;
        sum += error_m;
        squares += error_m * error_m;
    }
    const auto n = static_cast<double>(returns.size());
    EXPECT_NEAR(sum / n, 0.0, 5 * 0.02 / std::sqrt(n)) << "five standard errors";
    EXPECT_NEAR(std::sqrt(squares / n), 0.02, 5 * 0.02 / std::sqrt(2 * n));

    // Another thing in the way of half of the rays leaves the errors of the others.
    Scene other = wall();
    other.add(Box{{1, 0, -9}, {2, 9, 9}}, Part::moving);
    const auto again = simulateReturns(other, sensor, {}, errors, 7, 3);
    std::size_t same = 0;
    for (std::size_t i = 0; i < again.size(); ++i)
        if (again[i].truth.part == Part::wall) {
            ASSERT_EQ(again[i].range_m, returns[i].range_m);
            ++same;
        }
    EXPECT_EQ(same, again.size() / 2);
    const auto nextScan = simulateReturns(wall(), sensor, {}, errors, 7, 4);
    const auto otherSeed = simulateReturns(wall(), sensor, {}, errors, 8, 3);
    EXPECT_NE(nextScan[0].range_m, returns[0].range_m);
    EXPECT_NE(otherSeed[0].range_m, returns[0].range_m);
}

TEST(SimulatedSensor, DustShortensItsShareOfRays) {
    const SimulatedSensor sensor = depthCamera(200, 100, 60, 100.0);
    RangeErrors errors;
    errors.dustShare = 0.1;
    int shorter = 0;
    for (const SimulatedReturn& r : simulateReturns(wall(), sensor, {}, errors, 1, 0)) {
        if (r.range_m == r.truth.range_m) continue;
        ++shorter;
        ASSERT_GE(r.range_m, errors.dustFrom_m);
        ASSERT_LT(r.range_m, r.truth.range_m);
    }
    EXPECT_NEAR(shorter, 2000, 5 * std::sqrt(20000 * 0.1 * 0.9));
}

TEST(SimulatedSensor, ThreadsChangeNothing) {
    const SimulatedSensor sensor = ringLidar(16, -15, 15, 300);
    RangeErrors errors{0.02, 0.005};
    const int threads = omp_get_max_threads();
    omp_set_num_threads(1);
    const auto one = simulateReturns(wall(), sensor, {}, errors, 1, 0);
    omp_set_num_threads(4);
    const auto four = simulateReturns(wall(), sensor, {}, errors, 1, 0);
    omp_set_num_threads(threads);
    for (std::size_t i = 0; i < one.size(); ++i) ASSERT_EQ(one[i].range_m, four[i].range_m);
}

TEST(SimulatedSensor, IdealViewKnowsTheAngleOfIncidence) {
    SimulatedSensor sensor;
    sensor.directions_sensor = {Vector3d(0.6, 0.8, 0), Vector3d(1, 0, 0),
                                Vector3d(-1, 0, 0)};
    const auto view = idealView(wall(), sensor, {});
    ASSERT_EQ(view.size(), 2U) << "nothing is behind";
    EXPECT_NEAR(view[0].incidence, 0.6, 1e-12);
    EXPECT_NEAR((view[0].point_map - Vector3d(4, 4 / 0.6 * 0.8, 0)).norm(), 0, 1e-12);
    EXPECT_NEAR(view[1].incidence, 1.0, 1e-12);
}

TEST(SimulatedSensor, PlanarObservationHasTheSamePointsAndFlags) {
    const SimulatedSensor laser = planarLaser(541, 270, 8.0);
    const auto returns = simulateReturns(wall(), laser, {}, {}, 1, 0);
    const hgmm::Scan expected = scanOf(returns, laser, {}, WithoutReturn::leftOut);
    ASSERT_GT(expected.size(), 100U);
    ASSERT_LT(expected.size(), 500U);
    const auto observation = planarObservation(returns, laser, 270, NoReturn::invalidZero);
    const auto scan = hgmm::mrpt_bridge::observationToScan(observation);
    ASSERT_TRUE(scan);
    // A reading at the sensor's own limit is none.
    const auto within = [](const hgmm::Scan& s) {
        std::vector<Vector3d> points;
        for (std::size_t i = 0; i < s.size(); ++i) {
            const Vector3d p(s.x[i], s.y[i], s.z[i]);
            if (p.norm() < 7.9) points.push_back(p);
        }
        return points;
    };
    const auto got = within(*scan), wanted = within(expected);
    ASSERT_EQ(got.size(), wanted.size());
    for (std::size_t i = 0; i < got.size(); ++i)
        ASSERT_LT((got[i] - wanted[i]).norm(), 2e-4);
    EXPECT_EQ(observation.getScanRange(0), 0.F);
    EXPECT_FALSE(observation.getScanRangeValidity(0));
    const auto atRange = planarObservation(returns, laser, 270, NoReturn::invalidMaxRange);
    EXPECT_EQ(atRange.getScanRange(0), 8.F);
    EXPECT_FALSE(atRange.getScanRangeValidity(0));
    const auto valid = planarObservation(returns, laser, 270, NoReturn::validMaxRange);
    EXPECT_EQ(valid.getScanRange(0), 8.F);
    EXPECT_TRUE(valid.getScanRangeValidity(0));
}
