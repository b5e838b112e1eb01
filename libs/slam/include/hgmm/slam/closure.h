#pragma once
#include <cstddef>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "hgmm/registration.h"
#include "hgmm/slam/pose_graph.h"
#include "hgmm/slam/submap.h"

namespace hgmm::slam {

/// When a submap is believed to show what another one shows.
struct ClosureParams {
    int maxCandidates = 3;  ///< submaps that a finished one is compared with [count], >= 1
    /// Share of surfaces that must be found, of the submap that shows less [1], in (0, 1].
    double minOverlap = 0.3;
    /// Share of it that is enough of the submap that shows more [1], in [0, 1].
    double minOverlapBack = 0.5;
    double minExplained = 0.8;  ///< of what the other saw there at all [1], in (0, 1]
    /// Share of what the other saw there that may lie in its surely free space [1], in [0,
    /// 1): things that moved.
    double maxContradicted = 0.06;
    /// Of errors that registration does not know of: submaps are bent [m], > 0.
    double bend_m = 0.03;
    double bend_rad = 0.003;  ///< the same of rotations [rad], > 0
    RegistrationParams registration;

    /// Throws std::invalid_argument naming the field.
    void validate() const;
};

/// How the surfaces of one submap fit another's map.
struct Agreement {
    double overlap = 0.0;       ///< share of surfaces where the other has one [1]
    double explained = 0.0;     ///< of those in space that the other saw [1]
    double contradicted = 0.0;  ///< of those: in space that is surely free [1]
    /// The same of components, whatever their size: a chair tells as much as a wall [1].
    double contradictedComponents = 0.0;
};

/// Compares the surfaces of a submap, as they lie in the frame of another, with the other's
/// occupancy (thesis 4.3). A surface is found if it lies within the detail that is known at
/// its distance from either frame's origin.
Agreement agreementOf(const Map& target, const Mixture<3>& surfaces_source,
                      const Pose& T_target_source);

/// A submap that a finished one may overlap.
struct Candidate {
    std::size_t target = 0;         ///< submap
    UncertainPose T_target_source;  ///< as the graph has it
    double score = 0.0;             ///< of overlap and appearance, [0, 1]
};

/// A finished submap, shared between the front and the closures behind it.
struct FinishedSubmap {
    explicit FinishedSubmap(Submap&& s) : submap(std::move(s)), shape(submap) {}

    Submap submap;
    SubmapShape shape;
};

/// The submaps that `newest` is compared with: those that it may overlap, given how
/// uncertain the graph is about them, in the order of how much of it they would show and
/// how alike they look. Of neighbours in time, only the best. Not the submap before it,
/// if odometry knows how they lie.
std::vector<Candidate> candidatesFor(
    const std::vector<std::shared_ptr<const FinishedSubmap>>& submaps,
    const PoseGraph& graph, std::size_t newest, const ClosureParams& params);

/// Aligns a submap with another one from as many guesses as the uncertainty asks for, and
/// verifies the best: overlap, and no surface in space that the other saw to be free, both
/// ways. Nothing if it does not hold.
std::optional<UncertainPose> verifiedPose(const FinishedSubmap& target,
                                          const FinishedSubmap& source,
                                          const UncertainPose& T_target_source,
                                          const ClosureParams& params);

/// Whether two submaps cannot lie as the graph, which is sure of it, has them: much of one
/// is in space that the other saw to be free. The robot was carried away, or lost its way.
bool contradicts(const FinishedSubmap& target, const FinishedSubmap& source,
                 const UncertainPose& T_target_source);

/// The largest set of closures that agree with each other, pair by pair (pairwise
/// consistency maximisation: Mangelson et al. 2018, by greedy search): the loop through two
/// of them and the graph between must close within chi-square at .999.
/// @param graph odometry, and closures that are believed
/// @return indices into `closures`, rising
std::vector<std::size_t> consistentClosures(const PoseGraph& graph,
                                            const std::vector<PoseEdge>& closures);

/// Squared Mahalanobis distance of a closure from what the graph says, closure and graph
/// uncertain.
double disagreementWith(const PoseGraph& graph, const PoseEdge& closure);

/// Chi-square of six degrees of freedom at .999.
constexpr double kChiSquareOfSix = 22.46;

}  // namespace hgmm::slam
