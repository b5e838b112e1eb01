#include "hgmm/evaluation/room_figures.h"

#include <algorithm>
#include <cmath>
#include <random>
#include <stdexcept>
#include <string>

#include "hgmm/evaluation/split.h"

namespace hgmm::evaluation {
namespace {

constexpr int kFreePerRay = 3;
constexpr double kOnWall_m = 0.01;
constexpr double kMinShareOnWalls = 0.999;

/// Distance to the nearest wall, negative outside the room [m].
double depthInside(const Eigen::Vector3d& point_map, const Box& room) {
    return (point_map - room.low).cwiseMin(room.high - point_map).minCoeff();
}

/// A point behind the wall that was hit, `depth_m` from it at right angles.
Eigen::Vector3d behindWall(const Ray& ray, const Box& room, double depth_m) {
    int wall = 0;
    (ray.hit_map - room.low).cwiseMin(room.high - ray.hit_map).minCoeff(&wall);
    const Eigen::Vector3d along = ray.hit_map - ray.origin_map;
    return ray.hit_map + depth_m / std::abs(along[wall]) * along;
}

struct Questions {
    Points walls, free, hidden;
};

Questions questionsOf(const std::vector<Ray>& rays, const Box& room, std::uint64_t seed) {
    const double nearest_m = RoomFigures::kBehind_m[0];
    const double band_m = RoomFigures::kBehind_m[1] - nearest_m;
    std::mt19937_64 stream = randomStream(seed, 0, Draw::room);
    Questions q;
    for (const Ray& ray : rays) {
        q.walls.push_back(ray.hit_map);
        for (int k = 0; k < kFreePerRay; ++k) {
            const Eigen::Vector3d p =
                ray.origin_map + nextUniform(stream) * (ray.hit_map - ray.origin_map);
            if (depthInside(p, room) > RoomFigures::kBeforeWalls_m) q.free.push_back(p);
        }
        q.hidden.push_back(behindWall(ray, room, nearest_m + band_m * nextUniform(stream)));
    }
    return q;
}

/// Share of the points whose answer is as `isRight` wants it.
template <typename IsRight>
double share(const Map& map, const Points& points_map, const IsRight& isRight) {
    if (points_map.empty()) return 0.0;
    std::vector<Occupancy> answers(points_map.size());
    map.occupancy(points_map.data(), points_map.size(), answers.data());
    const auto right = std::count_if(answers.begin(), answers.end(), isRight);
    return static_cast<double>(right) / static_cast<double>(points_map.size());
}

}  // namespace

Box roomOf(const std::vector<Ray>& rays) {
    Points hits;
    for (const Ray& ray : rays) hits.push_back(ray.hit_map);
    const Box room = boundingBox(hits);
    const auto onWall = [&](const Ray& ray) {
        return depthInside(ray.hit_map, room) < kOnWall_m;
    };
    const auto on = std::count_if(rays.begin(), rays.end(), onWall);
    const double onShare = static_cast<double>(on) / static_cast<double>(rays.size());
    if (onShare < kMinShareOnWalls)
        throw std::invalid_argument(
            "not a noiseless recording of an empty box room along the axes: " +
            std::to_string(100.0 * (1.0 - onShare)) +
            " % of the points are more than 1 cm from the box around all");
    for (const Ray& ray : rays)
        if (!(depthInside(ray.origin_map, room) > 0.0))
            throw std::invalid_argument("a sensor is not inside the room");
    return room;
}

RoomFigures evaluateRoom(const Map& map, const std::vector<Ray>& rays, const Box& room,
                         std::uint64_t seed) {
    if (rays.empty()) throw std::invalid_argument("evaluateRoom: there are no rays");
    const Questions q = questionsOf(rays, room, seed);
    const auto isUnknown = [](const Occupancy& o) { return o.unknown > 0.5F; };
    RoomFigures f;
    f.wallPoints = q.walls.size();
    f.freePoints = q.free.size();
    f.hiddenPoints = q.hidden.size();
    f.wallOccupied =
        share(map, q.walls, [](const Occupancy& o) { return o.occupied > 0.5F; });
    f.freeNotOccupied =
        share(map, q.free, [](const Occupancy& o) { return o.occupied < 0.5F; });
    f.hiddenUnknown = share(map, q.hidden, isUnknown);
    f.freeUnknown = share(map, q.free, isUnknown);
    return f;
}

}  // namespace hgmm::evaluation
