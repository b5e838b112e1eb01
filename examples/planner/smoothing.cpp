#include "smoothing.h"

#include <algorithm>
#include <cmath>

namespace planner {

namespace {

constexpr double kMaxPlaces = 500.0;    // along one path
constexpr double kFirstDamping = 1.0;   // of steps, relative to nearness [1/m^2]
constexpr double kLeastDamping = 1e-2;  // grows with steps in vain, else shrinks
constexpr double kMostDamping = 1e4;
constexpr double kLeastGain = 1e-4;  // share of the cost, or the step was in vain
constexpr int kMaxSweeps = 200;

/// Solves (D + T) x = b, where D is diagonal and T has `off` beside its diagonal: forward
/// elimination and back substitution, as T is tridiagonal.
Eigen::MatrixX3d solved(Eigen::VectorXd diagonal, double off, Eigen::MatrixX3d b) {
    const Eigen::Index n = diagonal.size();
    for (Eigen::Index i = 1; i < n; ++i) {
        const double share = off / diagonal[i - 1];
        diagonal[i] -= share * off;
        b.row(i) -= share * b.row(i - 1);
    }
    b.row(n - 1) /= diagonal[n - 1];
    for (Eigen::Index i = n - 2; i >= 0; --i)
        b.row(i) = (b.row(i) - off * b.row(i + 1)) / diagonal[i];
    return b;
}

class Smoothing {
 public:
    Smoothing(const FreeSpace& space, const Path& path_map)
        : space_(space), spacing_m_(length_m(path_map) / double(path_map.size() - 1)) {}

    /// Of smoothness, and of nearness along the path.
    double cost(const Path& path) const {
        double sum = 0;
        for (std::size_t i = 1; i < path.size(); ++i) {
            const Eigen::Vector3d step = path[i] - path[i - 1];
            const double near = space_.nearness(space_.nearDistance(path[i]).distance_m);
            sum += 0.5 * step.squaredNorm() / spacing_m_ + step.norm() * near;
        }
        return sum;
    }

    /// Steps of the inner places to lower cost. CHOMP's metric, which spreads a push at
    /// one place along the path, has the curvature of nearness added, or steps near
    /// surfaces overshoot; and damping, as Levenberg and Marquardt have it.
    Eigen::MatrixX3d descent(const Path& path, double damping) const {
        const Eigen::Index inner = Eigen::Index(path.size()) - 2;
        Eigen::MatrixX3d gradient(inner, 3);
        Eigen::VectorXd metric = Eigen::VectorXd::Constant(inner, 2 / spacing_m_);
        for (Eigen::Index i = 0; i < inner; ++i) {
            const std::size_t k = static_cast<std::size_t>(i) + 1;
            const hgmm::SurfaceDistance surface = space_.nearDistance(path[k]);
            gradient.row(i) = smoothness(path, k) + nearness(path, k, surface);
            metric[i] +=
                spacing_m_ * (damping + space_.nearnessCurvature(surface.distance_m));
        }
        return -solved(metric, -1 / spacing_m_, gradient);
    }

    /// Moves each place by its step, if the robot can go there and on from there.
    Path stepped(Path path, const Eigen::MatrixX3d& steps) const {
        for (std::size_t i = 1; i + 1 < path.size(); ++i) {
            const Eigen::Vector3d to = path[i] + steps.row(Eigen::Index(i) - 1).transpose();
            if (space_.isFree(path[i - 1], to) && space_.isFree(to, path[i + 1]))
                path[i] = to;
        }
        return path;
    }

 private:
    Eigen::RowVector3d smoothness(const Path& path, std::size_t i) const {
        return (2 * path[i] - path[i - 1] - path[i + 1]).transpose() / spacing_m_;
    }

    /// Functional gradient of the integral of nearness over the length: across the path
    /// only, and weighed by its curvature.
    Eigen::RowVector3d nearness(const Path& path, std::size_t i,
                                const hgmm::SurfaceDistance& surface) const {
        const Eigen::Vector3d velocity = (path[i + 1] - path[i - 1]) / (2 * spacing_m_);
        const double speed = velocity.norm();
        if (!(speed > 0)) return Eigen::RowVector3d::Zero();
        const Eigen::Vector3d acceleration =
            (path[i + 1] - 2 * path[i] + path[i - 1]) / (spacing_m_ * spacing_m_);
        const Eigen::Vector3d tangent = velocity / speed;
        const auto across = [&](const Eigen::Vector3d& v) -> Eigen::Vector3d {
            return v - tangent.dot(v) * tangent;
        };
        const Eigen::Vector3d slope =
            space_.nearnessSlope(surface.distance_m) * surface.gradient;
        const Eigen::Vector3d curvature = across(acceleration) / (speed * speed);
        return spacing_m_ * speed *
               (across(slope) - space_.nearness(surface.distance_m) * curvature)
                   .transpose();
    }

    const FreeSpace& space_;
    double spacing_m_;
};

}  // namespace

Path smoothed(const FreeSpace& space, const Path& path_map) {
    const double length = length_m(path_map);
    Path best = subdivided(path_map, std::max(space.robot().radius_m, length / kMaxPlaces));
    if (best.size() < 3) return path_map;
    const Smoothing smoothing(space, best);
    double cost = smoothing.cost(best), damping = kFirstDamping;
    for (int sweep = 0; sweep < kMaxSweeps && damping < kMostDamping; ++sweep) {
        const Path next = smoothing.stepped(best, smoothing.descent(best, damping));
        const double nextCost = smoothing.cost(next);
        const bool gained = nextCost < (1 - kLeastGain) * cost;
        damping = gained ? std::max(kLeastDamping, damping / 3) : 4 * damping;
        if (nextCost < cost) {
            best = next;
            cost = nextCost;
        }
    }
    return best;
}

}  // namespace planner
