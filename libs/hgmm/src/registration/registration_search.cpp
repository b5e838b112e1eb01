#include "registration/registration_search.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <utility>

namespace hgmm {

namespace {

/// Nodes of the lattice in a standard deviation of the guess' rotation.
constexpr int kNodesPerAngle = 3;
/// The first stage's widths, of the guess' deviations: between nodes half their distance is
/// left.
constexpr double kFirstWidth = M_SQRT1_2;
constexpr double kFirstAngle = 0.5 / kNodesPerAngle;
/// Candidates of the first stage, and components that they are rated with.
constexpr std::size_t kCandidates = 24;
constexpr std::size_t kFewestComponents = 400;
/// Newton steps for each candidate where there are several.
constexpr int kStepsOfMany = 3;
/// In the first stage the guess weighs as this share of the source's components. It is
/// small for the information of so many, but keeps what slides along walls, or towards
/// more overlap, near the guess.
constexpr double kGuessShare = 0.05;
/// Candidates that lie this near, in widths, are one.
constexpr double kSame = 0.1;

struct Candidate {
    Pose T;  ///< of the source's centre
    double cost = 0.0;
    StageEnd end;
};

PosePrior priorOf(const RegistrationParams& params, const Pose& T_target_source_guess,
                  const RegistrationSource& source, double share) {
    PosePrior prior;
    prior.T_target_source_guess = T_target_source_guess;
    prior.centre = source.centre;
    prior.deviation = {params.coarseWidth_m, params.coarseAngle_rad};
    prior.weight = share * double(source.size());
    return prior;
}

void rate(const TargetLayers& target, const SearchRadius& searchRadius,
          const RegistrationSource& source, const PosePrior& prior, Candidate& candidate) {
    const auto neighbours = target.associate(source, searchRadius, candidate.T);
    candidate.cost = target.cost(source, neighbours, candidate.T) + prior.cost(candidate.T);
}

/// work(candidate) for each, on all threads where there are several.
template <typename Work>
void forEach(std::vector<Candidate>& candidates, const Work& work) {
    const auto n = static_cast<std::int64_t>(candidates.size());
#pragma omp parallel for schedule(dynamic) if (n > 1)
    for (std::int64_t k = 0; k < n; ++k) work(candidates[std::size_t(k)]);
}

/// The best that differ, best first.
void keepBest(std::vector<Candidate>& candidates, std::size_t most, double same_m,
              double gyrationRadius_m) {
    std::stable_sort(
        candidates.begin(), candidates.end(),
        [](const Candidate& a, const Candidate& b) { return a.cost < b.cost; });
    std::vector<Candidate> kept;
    for (const Candidate& c : candidates) {
        if (kept.size() == most) break;
        const bool known = std::any_of(kept.begin(), kept.end(), [&](const Candidate& k) {
            return (k.T.t - c.T.t).norm() + gyrationRadius_m * (k.T.R - c.T.R).norm() <
                   same_m;
        });
        if (!known) kept.push_back(c);
    }
    candidates = std::move(kept);
}

}  // namespace

std::vector<SearchRadius> stagesOf(const RegistrationParams& p) {
    const SearchRadius first{std::max(kFirstWidth * p.coarseWidth_m, p.fineWidth_m),
                             std::max(kFirstAngle * p.coarseAngle_rad, p.fineAngle_rad)};
    const double span =
        std::max(first.width_m / p.fineWidth_m, first.angle_rad / p.fineAngle_rad);
    const int steps = static_cast<int>(std::ceil(std::log2(span) - 1e-9));
    std::vector<SearchRadius> stages;
    for (int s = 0; s <= steps; ++s) {
        const double done = steps > 0 ? double(s) / steps : 1.0;
        const auto between = [done](double from, double to) {
            return from * std::pow(to / from, done);
        };
        stages.push_back({between(first.width_m, p.fineWidth_m),
                          between(first.angle_rad, p.fineAngle_rad)});
    }
    return stages;
}

std::vector<Eigen::Vector3d> rotationLattice(const RegistrationParams& params) {
    constexpr int n = kNodesPerAngle;
    std::vector<Eigen::Vector3d> nodes;
    for (int x = -n; x <= n; ++x)
        for (int y = -n; y <= n; ++y)
            for (int z = -n; z <= n; ++z)
                if (x * x + y * y + z * z <= n * n)
                    nodes.push_back(params.coarseAngle_rad / n * Eigen::Vector3d(x, y, z));
    return nodes;
}

std::vector<RegistrationSource> thinnedSources(RegistrationSource source) {
    constexpr double kFinestCells = 100.0;  // in the source's extent
    double cell_m = source.gyrationRadius_m / kFinestCells;
    std::vector<RegistrationSource> sources{std::move(source)};
    while (sources.back().size() > kFewestComponents) {
        const std::size_t most = std::max(kFewestComponents, sources.back().size() / 2);
        RegistrationSource thinner = sources.back();
        // On surfaces each step takes away about a third at most.
        for (; thinner.size() > most; cell_m *= 1.2) thinner = thinner.thinned(cell_m);
        sources.push_back(std::move(thinner));
    }
    std::reverse(sources.begin(), sources.end());
    return sources;
}

SearchEnd searchPose(const TargetLayers& target, const RegistrationParams& params,
                     const RegistrationSource& source, const Pose& T_target_source_guess) {
    const std::vector<SearchRadius> stages = stagesOf(params);
    const std::vector<RegistrationSource> sources = thinnedSources(source);
    std::vector<Candidate> candidates;
    for (const Eigen::Vector3d& w : rotationLattice(params)) {
        const Eigen::Matrix3d R = rotationOf(w) * T_target_source_guess.R;
        candidates.push_back({{R, T_target_source_guess.t + R * source.centre}, 0.0, {}});
    }
    SearchEnd result;
    std::size_t most = kCandidates;
    for (std::size_t s = 0; s < stages.size(); ++s) {
        const SearchRadius& searchRadius = stages[s];
        const bool last = s + 1 == stages.size();
        const RegistrationSource& some = sources[std::min(s, sources.size() - 1)];
        const PosePrior prior = priorOf(
            params, T_target_source_guess, some,
            last ? 0.0 : kGuessShare * searchRadius.width_m / stages.front().width_m);
        forEach(candidates,
                [&](Candidate& c) { rate(target, searchRadius, some, prior, c); });
        keepBest(candidates, last ? 1 : most, kSame * searchRadius.width_m,
                 source.gyrationRadius_m);
        if (last)
            remapDegenerate(target, searchRadius, some,
                            priorOf(params, T_target_source_guess, some, 1.0),
                            candidates.front().T);
        const int steps = candidates.size() > 1
                              ? std::min(kStepsOfMany, params.maxStageIterations)
                              : params.maxStageIterations;
        forEach(candidates, [&](Candidate& c) {
            c.end = runStage(target, searchRadius, some, prior, c.T, steps);
        });
        for (const Candidate& c : candidates) result.iterations += c.end.iterations;
        most = std::max<std::size_t>(most / 2, 1);
    }
    result.T_target_centre = candidates.front().T;
    result.last = candidates.front().end;
    return result;
}

}  // namespace hgmm
