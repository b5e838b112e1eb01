#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>

#include "hgmm/likelihood.h"
#include "hgmm/slam/closure.h"

namespace hgmm::slam {
namespace {

constexpr std::size_t kMaxGuesses = 400;
constexpr std::size_t kAligned = 4;        // guesses that are aligned, the best
constexpr std::size_t kRatedPoints = 150;  // components that rate a guess
/// A graph that is this sure of a pose [m], [rad] is wrong if so much of what one of the
/// submaps shows lies in what the other saw to be free [1].
constexpr double kSure_m = 0.5, kSure_rad = 0.1, kElsewhere = 0.15;
constexpr double kGuessSigmas = 2.0;  // of the graph's uncertainty that guesses span

/// Steps of at most `step` over +-extent, about 0.
std::vector<double> lattice(double extent, double step) {
    const int each = static_cast<int>(std::ceil(std::max(0.0, extent / step - 0.5)));
    std::vector<double> nodes;
    for (int k = -each; k <= each; ++k) nodes.push_back(k * step);
    return nodes;
}

/// The pose, and others about it where it is less certain than registration searches: in
/// the horizontal plane and in yaw, for range sensors stand on floors or know the vertical.
std::vector<Pose> guessesAbout(const UncertainPose& T_target_source,
                               const Eigen::Vector3d& centre_source,
                               const RegistrationParams& reach) {
    const Pose& pose = T_target_source.T_a_b;
    const Matrix6d& covariance = T_target_source.covariance;
    double width_m = kGuessSigmas * std::sqrt(std::max(covariance(3, 3), covariance(4, 4)));
    const double turn_rad = std::min(M_PI, kGuessSigmas * std::sqrt(covariance(2, 2)));
    const std::vector<double> turns = lattice(turn_rad, 1.5 * reach.coarseAngle_rad);
    double step_m = 1.5 * reach.coarseWidth_m;
    const auto count = [&] {
        const double side = 2.0 * std::ceil(std::max(0.0, width_m / step_m - 0.5)) + 1.0;
        return side * side * static_cast<double>(turns.size());
    };
    while (count() > static_cast<double>(kMaxGuesses) && step_m < 2.0 * width_m)
        step_m *= 1.25;
    const std::vector<double> shifts = lattice(width_m, step_m);

    const Eigen::Vector3d centre_target = pose.R * centre_source + pose.t;
    std::vector<Pose> guesses;
    for (const double turn : turns) {
        const Eigen::Matrix3d R = rotationOf({0, 0, turn});
        for (const double x : shifts)
            for (const double y : shifts)
                guesses.push_back({R * pose.R, R * (pose.t - centre_target) +
                                                   centre_target +
                                                   Eigen::Vector3d(x, y, 0)});
    }
    return guesses;
}

/// The most likely of the guesses, best first.
std::vector<Pose> bestOf(const std::vector<Pose>& guesses, const FinishedSubmap& target,
                         const Mixture<3>& source, const RegistrationParams& reach) {
    if (guesses.size() <= 1) return guesses;
    const SurfaceLikelihood likelihood(target.shape.surfaces_submap, reach.coarseWidth_m,
                                       0.1);
    const std::size_t points = std::min(source.size(), kRatedPoints);
    std::vector<std::pair<double, std::size_t>> rated;
    for (std::size_t g = 0; g < guesses.size(); ++g) {
        double sum = 0;
        for (std::size_t k = 0; k < points; ++k) {
            const Eigen::Vector3d mean = source[k * source.size() / points].mean;
            const Eigen::Vector3f p = (guesses[g].R * mean + guesses[g].t).cast<float>();
            sum += likelihood(p.x(), p.y(), p.z());
        }
        rated.emplace_back(-sum, g);
    }
    std::sort(rated.begin(), rated.end());
    std::vector<Pose> best;
    for (std::size_t k = 0; k < std::min(kAligned, rated.size()); ++k)
        best.push_back(guesses[rated[k].second]);
    return best;
}

/// Both ways: of the one that shows more, less overlap is enough.
bool holds(const Agreement& there, const Agreement& back, const ClosureParams& params) {
    return std::max(there.overlap, back.overlap) >= params.minOverlap &&
           std::min(there.overlap, back.overlap) >=
               params.minOverlapBack * params.minOverlap &&
           std::min(there.explained, back.explained) >= params.minExplained &&
           std::max({there.contradicted, back.contradicted, there.contradictedComponents,
                     back.contradictedComponents}) <= params.maxContradicted;
}

/// Registration's covariance, and what bends submaps; directions that surfaces do not hold
/// keep their size.
Matrix6d widened(const Matrix6d& covariance, const ClosureParams& params) {
    Matrix6d wider = covariance;
    wider.topLeftCorner<3, 3>().diagonal().array() += params.bend_rad * params.bend_rad;
    wider.bottomRightCorner<3, 3>().diagonal().array() += params.bend_m * params.bend_m;
    return wider;
}

}  // namespace

void ClosureParams::validate() const {
    const auto require = [](bool fine, const char* what) {
        if (!fine) throw std::invalid_argument(what);
    };
    require(maxCandidates >= 1, "maxCandidates: must be at least 1");
    require(minOverlap > 0 && minOverlap <= 1, "minOverlap: must be in (0, 1]");
    require(minOverlapBack >= 0 && minOverlapBack <= 1,
            "minOverlapBack: must be in [0, 1]");
    require(minExplained > 0 && minExplained <= 1, "minExplained: must be in (0, 1]");
    require(maxContradicted >= 0 && maxContradicted < 1,
            "maxContradicted: must be in [0, 1)");
    require(bend_m > 0, "bend_m: must be positive");
    require(bend_rad > 0, "bend_rad: must be positive");
    registration.validate();
}

bool contradicts(const FinishedSubmap& target, const FinishedSubmap& source,
                 const UncertainPose& T_target_source) {
    const Matrix6d& covariance = T_target_source.covariance;
    if (covariance.bottomRightCorner<3, 3>().diagonal().maxCoeff() > kSure_m * kSure_m ||
        covariance.topLeftCorner<3, 3>().diagonal().maxCoeff() > kSure_rad * kSure_rad)
        return false;
    const Pose& T = T_target_source.T_a_b;
    const Agreement there = agreementOf(target.submap.map, source.shape.surfaces_submap, T);
    const Agreement back =
        agreementOf(source.submap.map, target.shape.surfaces_submap, T.inverse());
    return std::max(there.contradicted, back.contradicted) > kElsewhere;
}

std::optional<UncertainPose> verifiedPose(const FinishedSubmap& target,
                                          const FinishedSubmap& source,
                                          const UncertainPose& T_target_source,
                                          const ClosureParams& params) {
    const Mixture<3>& surfaces = source.shape.surfaces_submap;
    if (surfaces.empty() || target.shape.surfaces_submap.empty()) return std::nullopt;
    const Mixture<3> all_target = surfacesInMapFrame(target.submap.map);
    const RegistrationTarget ready({&all_target}, params.registration);
    Registration best;
    for (const Pose& guess : bestOf(
             guessesAbout(T_target_source, source.shape.centre_submap, params.registration),
             target, surfaces, params.registration)) {
        const Registration found = ready.align(surfaces, guess);
        if (found.converged && (!best.converged || found.cost < best.cost)) best = found;
    }
    if (!best.converged) return std::nullopt;
    const Pose& T = best.T_target_source;
    const Agreement there = agreementOf(target.submap.map, surfaces, T);
    const Agreement back =
        agreementOf(source.submap.map, target.shape.surfaces_submap, T.inverse());
    if (!holds(there, back, params)) return std::nullopt;
    return UncertainPose{T, widened(best.covariance, params)};
}

}  // namespace hgmm::slam
