#include <algorithm>
#include <cmath>

#include "hgmm/slam/closure.h"

namespace hgmm::slam {
namespace {

constexpr std::size_t kAskedPoints = 200;  // components that tell the overlap
constexpr double kSigmas = 2.0;            // how far off the graph may be

/// Share of a submap's surfaces that are next to the target's, as near as the graph knows.
double expectedOverlap(const Map& target, const Mixture<3>& source,
                       const UncertainPose& T_target_source) {
    const std::size_t points = std::min(source.size(), kAskedPoints);
    const Pose& T = T_target_source.T_a_b;
    const Matrix6d& covariance = T_target_source.covariance;
    const double shift_m2 = covariance.bottomRightCorner<3, 3>().diagonal().maxCoeff();
    const double turn_rad2 = covariance.topLeftCorner<3, 3>().diagonal().maxCoeff();
    DistanceParams reach;
    std::size_t found = 0;
    for (std::size_t k = 0; k < points; ++k) {
        const Eigen::Vector3d p =
            T.R * Eigen::Vector3d(source[k * source.size() / points].mean);
        reach.maxDistance_m =
            0.3 + kSigmas * std::sqrt(shift_m2 + turn_rad2 * p.squaredNorm());
        reach.maxDistance_m = std::min(reach.maxDistance_m, 1e3);
        found += target.distance(p + T.t, reach).answered() ? 1 : 0;
    }
    return points == 0 ? 0.0 : static_cast<double>(found) / static_cast<double>(points);
}

/// Whether the spheres around two submaps may meet.
bool withinReach(const SubmapShape& target, const SubmapShape& source,
                 const UncertainPose& T_target_source) {
    const Eigen::Vector3d between = T_target_source.T_a_b.R * source.centre_submap +
                                    T_target_source.T_a_b.t - target.centre_submap;
    const double off_m = std::sqrt(
        T_target_source.covariance.bottomRightCorner<3, 3>().diagonal().maxCoeff());
    return between.norm() - kSigmas * off_m < target.radius_m + source.radius_m;
}

}  // namespace

std::vector<Candidate> candidatesFor(
    const std::vector<std::shared_ptr<const FinishedSubmap>>& submaps,
    const PoseGraph& graph, std::size_t newest, const ClosureParams& params) {
    const std::vector<UncertainPose> T_newest_other = poseOfAll(graph, newest);
    const FinishedSubmap& source = *submaps[newest];
    std::vector<Candidate> all;
    for (std::size_t j = 0; j < newest; ++j) {
        const FinishedSubmap& target = *submaps[j];
        Candidate candidate{j, T_newest_other[j].inverse(), 0.0};
        if (j + 1 == newest && !isGuess(candidate.T_target_source)) continue;
        if (!withinReach(target.shape, source.shape, candidate.T_target_source)) continue;
        const double overlap = expectedOverlap(
            target.submap.map, source.shape.surfaces_submap, candidate.T_target_source);
        if (overlap < params.minOverlap) continue;
        candidate.score =
            overlap * source.shape.appearance.similarity(target.shape.appearance);
        all.push_back(candidate);
    }
    std::stable_sort(all.begin(), all.end(), [](const Candidate& a, const Candidate& b) {
        return a.score > b.score;
    });
    std::vector<Candidate> chosen;
    for (const Candidate& candidate : all) {
        const bool besideAnother =
            std::any_of(chosen.begin(), chosen.end(), [&](const Candidate& c) {
                return std::max(c.target, candidate.target) -
                           std::min(c.target, candidate.target) <=
                       1;
            });
        if (besideAnother) continue;
        chosen.push_back(candidate);
        if (static_cast<int>(chosen.size()) == params.maxCandidates) break;
    }
    return chosen;
}

}  // namespace hgmm::slam
