#include "questions.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace equality {
namespace {

constexpr std::size_t kPoints = 20000;
constexpr std::size_t kRays = 1000;
constexpr double kMargin_m = 1.0;  // of the box around the map
constexpr double kBehind = 1.1;    // end of the rays' points, the surface being at 1

Eigen::Vector3d meanOf(const hgmm::Map& map, std::size_t i) {
    const auto& mean_local = map.mixture().mean;
    const Eigen::Vector3d local(mean_local[0][i], mean_local[1][i], mean_local[2][i]);
    return local + map.origin();
}

/// A point within a few standard deviations of a surface [m].
Eigen::Vector3d nearSurface(const hgmm::Map& map, Generator& generator) {
    const auto& mixture = map.mixture();
    const std::size_t i = generator.below(mixture.size());
    Eigen::Vector3d point_map = meanOf(map, i);
    for (int axis = 0; axis < 3; ++axis) {
        const auto diagonal = static_cast<std::size_t>(hgmm::packedIndex(3, axis, axis));
        const double variance_m2 = mixture.covariance[diagonal][i];
        point_map[axis] += std::sqrt(variance_m2) * generator.aboutNormal();
    }
    return point_map;
}

struct Box {
    Eigen::Vector3d low_map, high_map;
};

Box boxOf(const hgmm::Map& map) {
    Box box{meanOf(map, 0), meanOf(map, 0)};
    for (std::size_t i = 1; i < map.mixture().size(); ++i) {
        box.low_map = box.low_map.cwiseMin(meanOf(map, i));
        box.high_map = box.high_map.cwiseMax(meanOf(map, i));
    }
    box.low_map.array() -= kMargin_m;
    box.high_map.array() += kMargin_m;
    return box;
}

Eigen::Vector3d inBox(const Box& box, Generator& generator) {
    Eigen::Vector3d point_map;
    for (int axis = 0; axis < 3; ++axis)
        point_map[axis] = generator.uniform(box.low_map[axis], box.high_map[axis]);
    return point_map;
}

}  // namespace

std::uint64_t Generator::next() {
    std::uint64_t z = (state_ += 0x9E3779B97F4A7C15U);
    z = (z ^ (z >> 30U)) * 0xBF58476D1CE4E5B9U;
    z = (z ^ (z >> 27U)) * 0x94D049BB133111EBU;
    return z ^ (z >> 31U);
}

double Generator::uniform(double low, double high) {
    const double unit = static_cast<double>(next() >> 11U) * 0x1p-53;
    return low + (high - low) * unit;
}

double Generator::aboutNormal() {
    double sum = -6.0;
    for (int k = 0; k < 12; ++k) sum += uniform(0.0, 1.0);
    return sum;
}

Eigen::Vector3d Generator::inCube(double halfEdge) {
    const double x = uniform(-halfEdge, halfEdge), y = uniform(-halfEdge, halfEdge);
    return {x, y, uniform(-halfEdge, halfEdge)};
}

std::vector<Eigen::Vector3d> Questions::everyPoint(std::size_t step) const {
    std::vector<Eigen::Vector3d> some_map;
    for (std::size_t i = 0; i < points_map.size(); i += step)
        some_map.push_back(points_map[i]);
    return some_map;
}

Questions Questions::every(std::size_t step) const {
    Questions some;
    some.points_map = everyPoint(step);
    for (std::size_t i = 0; i < rays_map.size(); i += step)
        some.rays_map.push_back(rays_map[i]);
    return some;
}

Questions questionsFor(const hgmm::Map& map,
                       const std::vector<Eigen::Vector3d>& sensors_map) {
    if (map.empty()) throw std::runtime_error("the map is empty: there is nothing to ask");
    Generator generator(1);
    const Box box = boxOf(map);
    const auto draw = [&] {
        const Eigen::Vector3d& sensor_map =
            sensors_map[generator.below(sensors_map.size())];
        return Ray{sensor_map, nearSurface(map, generator) - sensor_map};
    };
    Questions questions;
    for (std::size_t i = 0; i < kPoints; ++i) {
        if (i % 3 == 0) {
            questions.points_map.push_back(inBox(box, generator));
        } else if (i % 3 == 1) {
            questions.points_map.push_back(nearSurface(map, generator));
        } else {
            const Ray ray = draw();
            questions.points_map.push_back(ray.origin_map + generator.uniform(0, kBehind) *
                                                                ray.direction_map);
        }
    }
    for (std::size_t i = 0; i < kRays; ++i) questions.rays_map.push_back(draw());
    return questions;
}

}  // namespace equality
