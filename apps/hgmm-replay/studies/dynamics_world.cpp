#include "studies/dynamics_world.h"

#include <Eigen/Geometry>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "hgmm/evaluation/planar_observation.h"
#include "hgmm/evaluation/split.h"
#include "hgmm/mrpt_bridge/observation_to_scan.h"
#include "interrupt.h"

namespace replay {

using namespace hgmm::evaluation;

namespace {

constexpr double kTurn = 6.283185307179586;  ///< [rad]
constexpr double kCircle_m = 0.5, kHeight_m = 1.0;
constexpr int kScansPerTurn = 200, kScansPerSway = 50;
constexpr double kApart_m = 0.12;  ///< points nearer to another thing do not count
constexpr std::size_t kStayingPoints = 800;  ///< of each class

}  // namespace

Observer observerOf(const std::string& name) {
    Observer observer;
    observer.errors.noise_m = 0.02;
    if (name == "16") {
        observer.sensor = ringLidar(16, -15.0, 15.0, 900);
    } else if (name == "32") {
        observer.sensor = ringLidar(32, -30.67, 10.67, 900);
    } else if (name == "camera") {
        observer.sensor = depthCamera(320, 240, 60.0);
        observer.sway_rad = 0.15;
    } else if (name == "2d") {
        observer.openingAngle_deg = 270.0;
        observer.sensor = planarLaser(541, observer.openingAngle_deg);
        observer.sway_rad = 0.15;
        observer.planar = true;
    } else {
        throw std::invalid_argument("--sensors: " + name +
                                    " is none of 2d, 16, 32 and camera");
    }
    return observer;
}

World::World(const Observer& observer, const MakeMaps& makeMaps, std::uint64_t seed)
    : observer_(observer), maps_(makeMaps()), seed_(seed) {
    std::mt19937_64 stream = randomStream(seed, 0, Draw::startPose);
    start_ = nextUniform(stream);
}

hgmm::Pose World::poseOf(int scan) const {
    const double angle = kTurn * (start_ + scan / double(kScansPerTurn));
    const double radius_m = observer_.parked ? 0.0 : kCircle_m;
    const double sway = std::sin(kTurn * (start_ + scan / double(kScansPerSway)));
    double yaw = observer_.sway_rad > 0.0 ? observer_.sway_rad * sway : angle + kTurn / 4;
    if (observer_.parked) yaw = 0.0;
    hgmm::Pose pose;
    pose.R = Eigen::AngleAxisd(yaw, Eigen::Vector3d::UnitZ()).toRotationMatrix();
    pose.t << changing_room::kMiddle.x() + radius_m * std::cos(angle),
        changing_room::kMiddle.y() + radius_m * std::sin(angle), kHeight_m;
    return pose;
}

void World::show(const Scene& scene) {
    const hgmm::Pose T_map_sensor = nextPose();
    const auto returns =
        simulateReturns(scene, observer_.sensor, T_map_sensor, observer_.errors, seed_,
                        static_cast<std::size_t>(scans_));
    ++scans_;
    hgmm::Scan scan;
    if (observer_.planar) {
        const auto observation = planarObservation(
            returns, observer_.sensor, observer_.openingAngle_deg, NoReturn::invalidZero);
        scan = *hgmm::mrpt_bridge::observationToScan(
            observation, hgmm::mrpt_bridge::toCPose3D(T_map_sensor));
    } else {
        // Zero pixels of cameras are mostly dark or near: they clear nothing.
        const bool clears = observer_.sensor.kind == SensorKind::lidar;
        scan = scanOf(returns, observer_.sensor, T_map_sensor,
                      clears ? WithoutReturn::clears : WithoutReturn::leftOut);
    }
    for (const auto& map : maps_) map->insert(scan);
}

void World::show(const Scene& scene, int scans) {
    for (int i = 0; i < scans && !interrupted(); ++i) show(scene);
}

std::vector<std::size_t> World::indices(std::size_t total, std::size_t n) const {
    return chooseIndices(total, n, seed_, static_cast<std::size_t>(scans_), Draw::view);
}

Points World::movingPoints(const Scene& scene, const hgmm::Pose& T_map_sensor,
                           std::size_t n) const {
    Points points;
    for (const SurfacePoint& p : idealView(scene, observer_.sensor, T_map_sensor))
        if (p.part == Part::moving && scene.distance(p.point_map, [](Part part) {
                return part != Part::moving;
            }) > kApart_m)
            points.push_back(p.point_map);
    return draw(points, n);
}

const char* StayingPoints::nameOf(int kind) {
    static const char* const names[kClasses] = {"wall", "floor", "table top", "pole",
                                                "grazing"};
    return names[kind];
}

StayingPoints::StayingPoints(const World& world, const Scene& scene) {
    constexpr double kGrazing = 0.25881904510252074;  // sine of 15 deg
    const auto isMoving = [](Part part) { return part == Part::moving; };
    for (const SurfacePoint& p :
         idealView(scene, world.observer().sensor, world.lastPose())) {
        if (isMoving(p.part) || scene.distance(p.point_map, isMoving) <= kApart_m) continue;
        if (p.part == Part::wall) points_[0].push_back(p.point_map);
        if (p.part == Part::floor) points_[1].push_back(p.point_map);
        if (p.part == Part::tableTop) points_[2].push_back(p.point_map);
        if (p.part == Part::pole) points_[3].push_back(p.point_map);
        if (p.incidence < kGrazing) points_[4].push_back(p.point_map);
    }
    for (Points& points : points_) points = world.draw(points, kStayingPoints);
}

std::vector<double> StayingPoints::occupiedShares(const MapUnderTest& map) const {
    std::vector<double> shares;
    for (const Points& points : points_)
        shares.push_back(points.empty() ? std::numeric_limits<double>::quiet_NaN()
                                        : shareOf(map.occupancy(points), saysOccupied));
    return shares;
}

}  // namespace replay
