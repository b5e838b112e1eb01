#include <algorithm>
#include <cmath>

#include "hgmm/slam/closure.h"

namespace hgmm::slam {
namespace {

constexpr double kSurelyFree = 0.9;   // P(free)
constexpr double kSurelyKnown = 0.5;  // 1 - P(unknown)

/// How far a surface may be from where it was seen to be: edges of the cells of a first
/// guess are what is resolved [m].
double toleranceAt(double range_m, const MapParams& params) {
    return 0.5 * params.cells.edgeAt(std::max(range_m, 1.0));
}

}  // namespace

Agreement agreementOf(const Map& target, const Mixture<3>& surfaces_source,
                      const Pose& T_target_source) {
    const std::size_t n = surfaces_source.size();
    Agreement agreement;
    if (n == 0) return agreement;
    std::vector<Eigen::Vector3d> points_target;
    std::vector<double> tolerances_m;
    for (std::size_t i = 0; i < n; ++i) {
        const Eigen::Vector3d point_source = surfaces_source[i].mean;
        points_target.push_back(T_target_source.R * point_source + T_target_source.t);
        const double range_m = std::max(point_source.norm(), points_target.back().norm());
        tolerances_m.push_back(toleranceAt(range_m, target.params()));
    }
    std::vector<Occupancy> occupancies(n);
    target.occupancy(points_target.data(), n, occupancies.data());
    std::vector<SurfaceDistance> distances(n);
    target.distance(points_target.data(), n, distances.data());
    std::size_t found = 0, seen = 0, contradicted = 0;
    for (std::size_t i = 0; i < n; ++i) {
        const bool near =
            distances[i].answered() && distances[i].distance_m <= tolerances_m[i];
        const bool known = near || 1.0 - double(occupancies[i].unknown) > kSurelyKnown;
        found += near ? 1 : 0;
        seen += known ? 1 : 0;
        contradicted += !near && double(occupancies[i].free) > kSurelyFree ? 1 : 0;
    }
    const auto share = [](std::size_t part, std::size_t whole) {
        return whole == 0 ? 0.0 : static_cast<double>(part) / static_cast<double>(whole);
    };
    return {share(found, n), share(found, seen), share(contradicted, seen)};
}

}  // namespace hgmm::slam
