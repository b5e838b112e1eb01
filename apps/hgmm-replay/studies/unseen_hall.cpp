#include "studies/unseen_hall.h"

#include <mrpt/maps/COccupancyGridMap2D.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "format.h"
#include "hgmm/evaluation/split.h"
#include "hgmm/evaluation/unseen_points.h"
#include "hgmm/mrpt_bridge/observation_to_scan.h"
#include "interrupt.h"

namespace replay {
namespace {

using namespace hgmm::evaluation;

constexpr double kLength_m = 60.0, kWidth_m = 40.0;
constexpr double kOpening_deg = 270.0, kLaserNoise_m = 0.01;
constexpr double kFarthest_m = 15.0;  ///< of points asked for: the grid inserts no farther
constexpr int kScans = 120;
constexpr std::size_t kRaysPerScan = 100;

/// MRPT's 2D grid, which is given observations.
class Grid2d {
 public:
    Grid2d(const char* name, bool clearsInvalid)
        : name_(name), map_(-5.F, kLength_m + 5.F, -5.F, kWidth_m + 5.F, 0.05F) {
        map_.insertionOptions.considerInvalidRangesAsFreeSpace = clearsInvalid;
    }

    const char* name() const { return name_; }
    void insert(const mrpt::obs::CObservation2DRangeScan& observation,
                const mrpt::poses::CPose3D& T_map_robot) {
        map_.insertObservation(observation, T_map_robot);
    }
    std::vector<hgmm::Occupancy> occupancy(const Points& points_map) const {
        std::vector<hgmm::Occupancy> answers;
        for (const Eigen::Vector3d& p : points_map) {
            const double free =
                map_.getPos(static_cast<float>(p.x()), static_cast<float>(p.y()));
            // A cell at even odds is taken for untouched.
            const bool unknown = std::abs(free - 0.5) < 0.01;
            answers.push_back(occupancyOfAnswer({1.0 - free, unknown}));
        }
        return answers;
    }

 private:
    const char* name_;
    mrpt::maps::COccupancyGridMap2D map_;
};

Scene hall() {
    Scene scene;
    scene.add(Box{{-1, -1, -1}, {0, kWidth_m + 1, 4}}, Part::wall);
    scene.add(Box{{kLength_m, -1, -1}, {kLength_m + 1, kWidth_m + 1, 4}}, Part::wall);
    scene.add(Box{{-1, -1, -1}, {kLength_m + 1, 0, 4}}, Part::wall);
    scene.add(Box{{-1, kWidth_m, -1}, {kLength_m + 1, kWidth_m + 1, 4}}, Part::wall);
    scene.add(Pillar{{30.0, 24.0}, 0.5, -1, 4}, Part::solid);
    return scene;
}

/// On a straight way of 30 m, looking ahead.
hgmm::Pose poseOf(int scan) {
    const Eigen::Vector2d from(16.0, 14.0), to(44.0, 24.77);
    const Eigen::Vector2d at = from + scan / (kScans - 1.0) * (to - from);
    hgmm::Pose pose;
    const double yaw = std::atan2((to - from).y(), (to - from).x());
    pose.R = Eigen::AngleAxisd(yaw, Eigen::Vector3d::UnitZ()).toRotationMatrix();
    pose.t << at.x(), at.y(), 0.0;
    return pose;
}

/// Points that rays passed, and ends of rays without a return.
struct Questions {
    Points passed_map, ends_map;  ///< [m]

    void add(const std::vector<SimulatedReturn>& returns, const SimulatedSensor& laser,
             const Scene& scene, const hgmm::Pose& T_map_sensor, std::uint64_t seed,
             std::size_t scan) {
        constexpr double kFromWalls_m = 0.3;
        std::mt19937_64 stream = randomStream(seed, scan, Draw::uniformFree);
        for (const std::size_t i :
             chooseIndices(returns.size(), kRaysPerScan, seed, scan, Draw::view)) {
            const double share = nextUniform(stream);
            const Eigen::Vector3d along = T_map_sensor.R * laser.directions_sensor[i];
            const double reach_m =
                returns[i].hit ? returns[i].truth.range_m : laser.maxRange_m;
            if (const auto range_m =
                    rangeIn(FreeBand{}, std::min(reach_m, kFarthest_m), share))
                passed_map.push_back(T_map_sensor.t + *range_m * along);
            const Eigen::Vector3d end_map = T_map_sensor.t + laser.maxRange_m * along;
            if (!returns[i].hit &&
                scene.distance(end_map, [](Part) { return true; }) > kFromWalls_m)
                ends_map.push_back(end_map);
        }
    }
};

const char* nameOf(NoReturn noReturn) {
    switch (noReturn) {
        case NoReturn::invalidZero:
            return "invalid, 0";
        case NoReturn::invalidMaxRange:
            return "invalid, max";
        case NoReturn::validMaxRange:
            return "valid, max";
    }
    return "";
}

}  // namespace

FigureTable hallTable() {
    using Worst = FigureColumn::Worst;
    return {
        "hall",
        "Hall of 60 x 40 m: answers where rays passed, and where rays without a return end",
        {"limit [m]", "no return is", "map"},
        {{"free", "passed_free", 4, Worst::smallest, ">=grid"},
         {"occupied", "passed_occupied", 4, Worst::largest},
         {"unknown", "passed_unknown", 4, Worst::largest},
         {"phantom wall", "phantom_wall", 4, Worst::largest, "0"}}};
}

void studyHall(double limit_m, NoReturn noReturn, std::uint64_t seed,
               const MakeMaps& makeMaps, FigureTable& table) {
    const SimulatedSensor laser = planarLaser(541, kOpening_deg, limit_m);
    const Scene scene = hall();
    const auto maps = makeMaps();
    Grid2d grids[] = {{"grid2d", true}, {"grid2d, invalid unused", false}};
    Questions questions;
    for (int i = 0; i < kScans && !interrupted(); ++i) {
        const hgmm::Pose T_map_sensor = poseOf(i);
        const auto scanIndex = static_cast<std::size_t>(i);
        const auto returns =
            simulateReturns(scene, laser, T_map_sensor, {kLaserNoise_m}, seed, scanIndex);
        const auto observation = planarObservation(returns, laser, kOpening_deg, noReturn);
        const auto pose = hgmm::mrpt_bridge::toCPose3D(T_map_sensor);
        const auto scan = hgmm::mrpt_bridge::observationToScan(observation, pose);
        for (const auto& map : maps) map->insert(*scan);
        for (Grid2d& grid : grids) grid.insert(observation, pose);
        questions.add(returns, laser, scene, T_map_sensor, seed, scanIndex);
    }
    const auto report = [&](const std::string& name, const auto& map) {
        const auto passed = map.occupancy(questions.passed_map);
        const auto ends = map.occupancy(questions.ends_map);
        const auto isFree = [](const hgmm::Occupancy& o) { return o.free > 0.5F; };
        const auto isOccupied = [](const hgmm::Occupancy& o) { return o.occupied > 0.5F; };
        const double free = shareOf(passed, isFree), occupied = shareOf(passed, isOccupied);
        table.add({format("%g", limit_m), nameOf(noReturn), name},
                  {free, occupied, std::max(0.0, 1.0 - free - occupied),
                   shareOf(ends, isOccupied)});
    };
    for (const auto& map : maps) report(map->name(), *map);
    for (const Grid2d& grid : grids) report(grid.name(), grid);
}

}  // namespace replay
