#pragma once
#include <cstddef>
#include <optional>
#include <vector>

#include "hgmm/map.h"
#include "hgmm/scan.h"
#include "hgmm/tracker.h"
#include "occupancy/patch_tree.h"
#include "registration/surface_alignment.h"

namespace hgmm {

/// A pose of a scan, and how it fits what the map knows.
struct PoseHypothesis : PoseEstimate {
    double overlap = 0.0;       ///< share of the samples that lie on a surface, [0, 1]
    double contradicted = 0.0;  ///< share of them in space that is known to be free, [0, 1]
    int observable = 0;         ///< directions that the surfaces hold [count], 0 to 6

    /// Unknown space says nothing.
    double score() const { return overlap - contradicted; }
};

/// Looks for the pose of one scan in a map, nearer and farther.
class ScanAlignment {
 public:
    /// All are kept by reference.
    /// @param surfaces of the map, in its local frame
    /// @param most samples that are aligned
    ScanAlignment(const Map& map, const PatchTree<3>& surfaces, const ScanSamples& scan,
                  std::size_t most);

    /// About a prior that may be off by a little.
    PoseHypothesis near(const PoseEstimate& prior, const SearchRadius& off) const;
    /// By registering mixtures, which looks farther, about the prior's rotation, too.
    std::optional<PoseHypothesis> farther(const PoseEstimate& prior) const;
    /// In all headings about the map's z axis, of places about the prior, as far as half of
    /// the scan reaches: the likeliest, aligned roughly.
    std::vector<PoseHypothesis> farAround(const PoseEstimate& prior) const;
    /// A rough pose, aligned well.
    PoseHypothesis refined(const PoseHypothesis& hypothesis,
                           const PoseEstimate& prior) const;
    /// Share of the samples that are seen through surfaces of the map, [0, 1].
    double shareBehindSurfaces(const Pose& T_map_sensor) const;

 private:
    PoseHypothesis aligned(const PoseEstimate& prior, const SearchRadius& off,
                           const AlignmentSamples& samples) const;
    /// Of a prior that may be off by more.
    Registration::Covariance widened(const Registration::Covariance& covariance,
                                     const SearchRadius& by) const;
    std::vector<Eigen::Vector3d> askedPoints(const Pose& T_map_sensor) const;
    double shareInFreeSpace(const Pose& T_map_sensor) const;

    const Map& map_;
    const PatchTree<3>& surfaces_;
    const ScanSamples& scan_;
    AlignmentSamples samples_;
    AlignmentSamples asked_;
};

/// Of some hypotheses the nearest to the prior that fits about as well as any; none, where
/// it is far from the prior and another place fits as well that is hardly farther.
/// @param hypotheses at least one
/// @param priorIsVague other places that fit as well count wherever they are
std::optional<std::size_t> clearlyBest(const std::vector<PoseHypothesis>& hypotheses,
                                       const Pose& prior, const SearchRadius& off,
                                       bool priorIsVague);

}  // namespace hgmm
