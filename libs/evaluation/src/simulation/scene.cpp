#include "hgmm/evaluation/scene.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace hgmm::evaluation {
namespace {

/// Takes the box into account, if the ray enters it before `nearest`.
/// @param inverse of each coordinate of the direction
void castAtBox(const Box& box, Part part, const Eigen::Vector3d& origin,
               const Eigen::Vector3d& direction, const Eigen::Vector3d& inverse,
               SceneHit& nearest) {
    double enter = 0.0, leave = nearest.range_m;
    int axisOfEntry = -1;
    for (int axis = 0; axis < 3; ++axis) {
        if (direction[axis] == 0.0) {
            if (origin[axis] <= box.low[axis] || origin[axis] >= box.high[axis]) return;
            continue;
        }
        double first = (box.low[axis] - origin[axis]) * inverse[axis];
        double second = (box.high[axis] - origin[axis]) * inverse[axis];
        if (first > second) std::swap(first, second);
        if (first > enter) {
            enter = first;
            axisOfEntry = axis;
        }
        leave = std::min(leave, second);
        if (enter >= leave) return;
    }
    if (axisOfEntry < 0) return;
    nearest = {enter, Eigen::Vector3d::Zero(), part};
    nearest.normal[axisOfEntry] = direction[axisOfEntry] > 0.0 ? -1.0 : 1.0;
}

/// The same for a pillar: first its sides, then the end that the ray comes from.
void castAtPillar(const Pillar& p, Part part, const Eigen::Vector3d& origin,
                  const Eigen::Vector3d& direction, SceneHit& nearest) {
    const Eigen::Vector2d from = origin.head<2>() - p.axis, along = direction.head<2>();
    const double a = along.squaredNorm(), b = from.dot(along);
    const double c = from.squaredNorm() - p.radius_m * p.radius_m;
    const double root = b * b - a * c;
    if (a > 0.0 && root > 0.0) {
        const double range_m = (-b - std::sqrt(root)) / a;
        const double height_m = origin.z() + range_m * direction.z();
        if (range_m > 0.0 && range_m < nearest.range_m && height_m > p.bottom_m &&
            height_m < p.top_m) {
            const Eigen::Vector2d out = (from + range_m * along) / p.radius_m;
            nearest = {range_m, {out.x(), out.y(), 0.0}, part};
        }
    }
    if (direction.z() == 0.0) return;
    const bool down = direction.z() < 0.0;
    const double range_m = ((down ? p.top_m : p.bottom_m) - origin.z()) / direction.z();
    if (range_m <= 0.0 || range_m >= nearest.range_m) return;
    if ((from + range_m * along).norm() < p.radius_m)
        nearest = {range_m, {0.0, 0.0, down ? 1.0 : -1.0}, part};
}

}  // namespace

void Scene::add(const Box& box, Part part) {
    if (!(box.low.array() < box.high.array()).all())
        throw std::invalid_argument("a box of a scene must have low < high on each axis");
    boxes_.push_back({box, part});
}

void Scene::add(const Pillar& pillar, Part part) {
    if (!(pillar.radius_m > 0.0 && pillar.top_m > pillar.bottom_m))
        throw std::invalid_argument("a pillar must have a positive radius and height");
    pillars_.push_back({pillar, part});
}

std::optional<SceneHit> Scene::cast(const Eigen::Vector3d& origin,
                                    const Eigen::Vector3d& direction) const {
    SceneHit nearest;
    const Eigen::Vector3d inverse = direction.cwiseInverse();
    for (const PartBox& b : boxes_)
        castAtBox(b.box, b.part, origin, direction, inverse, nearest);
    for (const PartPillar& p : pillars_)
        castAtPillar(p.pillar, p.part, origin, direction, nearest);
    if (!std::isfinite(nearest.range_m)) return std::nullopt;
    return nearest;
}

double Scene::distanceTo(const Box& box, const Eigen::Vector3d& point) {
    return (box.low - point).cwiseMax(point - box.high).cwiseMax(0.0).norm();
}

double Scene::distanceTo(const Pillar& p, const Eigen::Vector3d& point) {
    const double aside_m = (point.head<2>() - p.axis).norm() - p.radius_m;
    const double above_m = std::max(p.bottom_m - point.z(), point.z() - p.top_m);
    return std::hypot(std::max(aside_m, 0.0), std::max(above_m, 0.0));
}

}  // namespace hgmm::evaluation
