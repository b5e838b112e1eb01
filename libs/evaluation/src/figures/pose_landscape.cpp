#include "hgmm/evaluation/pose_landscape.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <vector>

#include "hgmm/evaluation/split.h"

namespace hgmm::evaluation {
namespace {

/// Translation [m] along the axes of the map, then the rotation vector about those of the
/// pose, times the lever [m].
using Offset = std::array<double, 6>;

constexpr double kDegree = 0.017453292519943295;

Pose moved(const Pose& pose, const Offset& o, double lever_m) {
    const Eigen::Vector3d w = Eigen::Vector3d(o[3], o[4], o[5]) / lever_m;
    const double angle = w.norm();
    if (angle < 1e-12) return {pose.R, pose.t + Eigen::Vector3d(o[0], o[1], o[2])};
    return {pose.R * Eigen::AngleAxisd(angle, w / angle).toRotationMatrix(),
            pose.t + Eigen::Vector3d(o[0], o[1], o[2])};
}

std::vector<int> axesOf(const PoseSearch& search) {
    return search.planar ? std::vector<int>{0, 1, 5} : std::vector<int>{0, 1, 2, 3, 4, 5};
}

/// Ways to move by 1 m: along the axes, and about those of the pose through the pivot.
std::vector<Offset> directionsOf(const Pose& origin, const PoseSearch& search) {
    std::vector<Offset> directions;
    for (const int axis : axesOf(search)) directions.emplace_back()[axis] = 1;
    if (search.pivot.isZero()) return directions;
    for (const int axis : axesOf(search)) {
        if (axis < 3) continue;
        const Eigen::Vector3d shift =
            origin.R * search.pivot.cross(Eigen::Vector3d::Unit(axis - 3)) / search.lever_m;
        Offset& direction = directions.emplace_back();
        direction[axis] = 1;
        for (int d = 0; d < (search.planar ? 2 : 3); ++d) direction[d] = shift[d];
    }
    return directions;
}

Eigen::Vector3d direction(std::mt19937_64& stream, bool planar) {
    const double angle = 2 * M_PI * nextUniform(stream);
    const double z = planar ? 0.0 : 2 * nextUniform(stream) - 1;
    const double r = std::sqrt(1 - z * z);
    return {r * std::cos(angle), r * std::sin(angle), z};
}

struct Rated {
    Offset offset{};
    double value = 0.0;
};

class Climber {
 public:
    Climber(const PoseScore& score, const Pose& origin, const PoseSearch& search)
        : score_(score),
          origin_(origin),
          search_(search),
          directions_(directionsOf(origin, search)) {}

    Rated rate(const Offset& offset) const {
        return {offset, score_(moved(origin_, offset, search_.lever_m))};
    }

    Rated climb(Rated best) const {
        for (double step = search_.firstStep_m; step >= search_.lastStep_m; step /= 2)
            best = climbWith(step, best);
        return best;
    }

 private:
    /// Enough for a path of many metres; ends walks on plateaus of rounding errors.
    static constexpr int kMaxStrides = 200;

    Rated climbWith(double step, Rated best) const {
        Rated reached = explored(best, step);
        for (int k = 0; k < kMaxStrides && reached.value > best.value; ++k) {
            Offset ahead{};
            for (int i = 0; i < 6; ++i) ahead[i] = 2 * reached.offset[i] - best.offset[i];
            best = reached;
            reached = explored(rate(ahead), step);
            if (reached.value <= best.value) reached = explored(best, step);
        }
        return best;
    }

    /// After one step in each direction that leads up.
    Rated explored(Rated from, double step) const {
        for (const Offset& direction : directions_)
            for (const double sign : {1.0, -1.0}) {
                Offset offset = from.offset;
                for (int i = 0; i < 6; ++i) offset[i] += sign * step * direction[i];
                const Rated next = rate(offset);
                if (next.value <= from.value) continue;
                from = next;
                break;
            }
        return from;
    }

    const PoseScore& score_;
    const Pose& origin_;
    const PoseSearch& search_;
    const std::vector<Offset> directions_;
};

/// Nodes by number.
class Lattice {
 public:
    Lattice(double reach_m, double reach_deg, const PoseSearch& search,
            std::mt19937_64& stream)
        : step_m_(search.firstStep_m) {
        counts_.fill(1);
        for (const int axis : axesOf(search)) {
            const double reach = axis < 3 ? reach_m : reach_deg * kDegree * search.lever_m;
            counts_[axis] = 2 * static_cast<std::size_t>(std::ceil(reach / step_m_)) + 1;
            low_[axis] =
                step_m_ * (nextUniform(stream) - 0.5 - double((counts_[axis] - 1) / 2));
        }
    }
    std::size_t size() const {
        return std::accumulate(counts_.begin(), counts_.end(), std::size_t{1},
                               std::multiplies<>());
    }
    Offset node(std::size_t number) const {
        Offset offset{};
        for (int axis = 0; axis < 6; ++axis) {
            offset[axis] = low_[axis] + step_m_ * double(number % counts_[axis]);
            number /= counts_[axis];
        }
        return offset;
    }

 private:
    double step_m_;
    std::array<std::size_t, 6> counts_{};
    Offset low_{};
};

}  // namespace

PoseError errorOf(const Pose& estimate, const Pose& truth) {
    const Eigen::Matrix3d R = truth.R.transpose() * estimate.R;
    return {(estimate.t - truth.t).norm(), Eigen::AngleAxisd(R).angle() / kDegree};
}

Pose displaced(const Pose& pose, double distance_m, double angle_deg, bool planar,
               std::mt19937_64& stream) {
    const Eigen::Vector3d shift = distance_m * direction(stream, planar);
    const Eigen::Vector3d axis =
        planar ? Eigen::Vector3d(0, 0, nextUniform(stream) < 0.5 ? -1 : 1)
               : direction(stream, false);
    return {pose.R * Eigen::AngleAxisd(angle_deg * kDegree, axis).toRotationMatrix(),
            pose.t + shift};
}

Pose climb(const PoseScore& score, const Pose& start, const PoseSearch& search) {
    const Climber climber(score, start, search);
    return moved(start, climber.climb(climber.rate({})).offset, search.lever_m);
}

Pose highestAround(const PoseScore& score, const Pose& centre, double reach_m,
                   double reach_deg, const PoseSearch& search, std::mt19937_64& stream) {
    const Climber climber(score, centre, search);
    const Lattice lattice(reach_m, reach_deg, search, stream);
    const auto nodes = static_cast<std::ptrdiff_t>(lattice.size());
    std::vector<double> values(lattice.size());
#pragma omp parallel for schedule(static)
    for (std::ptrdiff_t i = 0; i < nodes; ++i)
        values[std::size_t(i)] = climber.rate(lattice.node(std::size_t(i))).value;

    std::vector<std::size_t> order(lattice.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    const auto climbed = std::min<std::ptrdiff_t>(kClimbed, nodes);
    std::partial_sort(order.begin(), order.begin() + climbed, order.end(),
                      [&](std::size_t a, std::size_t b) {
                          return values[a] > values[b] || (values[a] == values[b] && a < b);
                      });
    std::vector<Rated> tops(static_cast<std::size_t>(climbed));
#pragma omp parallel for schedule(dynamic)
    for (std::ptrdiff_t k = 0; k < climbed; ++k) {
        const std::size_t i = order[std::size_t(k)];
        tops[std::size_t(k)] = climber.climb({lattice.node(i), values[i]});
    }
    const auto highest =
        std::max_element(tops.begin(), tops.end(),
                         [](const Rated& a, const Rated& b) { return a.value < b.value; });
    return moved(centre, highest->offset, search.lever_m);
}

}  // namespace hgmm::evaluation
