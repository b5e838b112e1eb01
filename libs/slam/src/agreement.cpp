#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

#include "hgmm/slam/closure.h"

namespace hgmm::slam {
namespace {

constexpr double kSurelyFree = 0.9;   // P(free)
constexpr double kSurelyKnown = 0.5;  // 1 - P(unknown)

constexpr std::size_t kMostPoints = 1000;
constexpr double kFinestSpacing_m = 0.2;

/// A component's rectangle: a uniform one with its covariance.
struct Rectangle {
    explicit Rectangle(const Gaussian<3>& component) : mean(component.mean) {
        const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> eigen(
            Eigen::Matrix3d(component.covariance));
        axes = eigen.eigenvectors().rightCols<2>();
        edges_m = std::sqrt(12.0) * eigen.eigenvalues().tail<2>().cwiseMax(0.0).cwiseSqrt();
    }
    Eigen::Array2i cuts(double spacing_m) const {
        return (edges_m.array() / spacing_m).ceil().max(1.0).min(1e3).cast<int>();
    }

    Eigen::Vector3d mean;
    Eigen::Matrix<double, 3, 2> axes;
    Eigen::Vector2d edges_m;
};

struct SurfacePoint {
    Eigen::Vector3d position;
    double ofComponent;  ///< its share of its component [1]
};

/// Points that lie evenly on surfaces: a wall counts by its size, however many components
/// it has.
std::vector<SurfacePoint> pointsOn(const Mixture<3>& surfaces) {
    std::vector<Rectangle> rectangles;
    for (std::size_t i = 0; i < surfaces.size(); ++i) rectangles.emplace_back(surfaces[i]);
    const auto count = [&](double spacing_m) {
        std::size_t sum = 0;
        for (const Rectangle& r : rectangles)
            sum += static_cast<std::size_t>(r.cuts(spacing_m).prod());
        return sum;
    };
    double spacing_m = kFinestSpacing_m;
    while (count(spacing_m) > std::max(kMostPoints, surfaces.size())) spacing_m *= M_SQRT2;
    std::vector<SurfacePoint> points;
    for (const Rectangle& r : rectangles) {
        const Eigen::Array2i n = r.cuts(spacing_m);
        for (int a = 0; a < n[0]; ++a)
            for (int b = 0; b < n[1]; ++b)
                points.push_back(
                    {r.mean + r.axes.col(0) * r.edges_m[0] * ((a + 0.5) / n[0] - 0.5) +
                         r.axes.col(1) * r.edges_m[1] * ((b + 0.5) / n[1] - 0.5),
                     1.0 / n.prod()});
    }
    return points;
}

/// How far a surface may be from where it was seen to be: edges of the cells of a first
/// guess are what is resolved [m].
double toleranceAt(double range_m, const MapParams& params) {
    return 0.5 * params.cells.edgeAt(std::max(range_m, 1.0));
}

}  // namespace

Agreement agreementOf(const Map& target, const Mixture<3>& surfaces_source,
                      const Pose& T_target_source) {
    const std::vector<SurfacePoint> points_source = pointsOn(surfaces_source);
    const std::size_t n = points_source.size();
    Agreement agreement;
    if (n == 0) return agreement;
    std::vector<Eigen::Vector3d> points_target;
    std::vector<double> tolerances_m;
    for (std::size_t i = 0; i < n; ++i) {
        const Eigen::Vector3d& point_source = points_source[i].position;
        points_target.push_back(T_target_source.R * point_source + T_target_source.t);
        const double range_m = std::max(point_source.norm(), points_target.back().norm());
        tolerances_m.push_back(toleranceAt(range_m, target.params()));
    }
    std::vector<Occupancy> occupancies(n);
    target.occupancy(points_target.data(), n, occupancies.data());
    std::vector<SurfaceDistance> distances(n);
    target.distance(points_target.data(), n, distances.data());
    // Of points, by size; and of components, where a chair counts as much as a wall.
    std::size_t found = 0, seen = 0, contradicted = 0;
    double seenComponents = 0.0, contradictedComponents = 0.0;
    for (std::size_t i = 0; i < n; ++i) {
        const bool near =
            distances[i].answered() && distances[i].distance_m <= tolerances_m[i];
        const bool known = near || 1.0 - double(occupancies[i].unknown) > kSurelyKnown;
        found += near ? 1 : 0;
        seen += known ? 1 : 0;
        if (known) seenComponents += points_source[i].ofComponent;
        if (near || !(double(occupancies[i].free) > kSurelyFree)) continue;
        ++contradicted;
        contradictedComponents += points_source[i].ofComponent;
    }
    const auto share = [](double part, double whole) {
        return whole > 0.0 ? part / whole : 0.0;
    };
    return {share(double(found), double(n)), share(double(found), double(seen)),
            share(double(contradicted), double(seen)),
            share(contradictedComponents, seenComponents)};
}

}  // namespace hgmm::slam
