#pragma once
#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "hgmm/scan.h"
#include "occupancy/patch_tree.h"
#include "registration/registration_cost.h"
#include "registration/registration_layers.h"
#include "registration/surface_alignment.h"

namespace hgmm {

/// A sample and the patch nearest to it.
struct SamplePair {
    std::uint32_t slot = SurfaceDistance::kNone;  ///< in the tree; kNone: none in reach
    float squaredDistance_m2 = 0.F;
};

/// Sums over pairs of half the squared normalised distance, weighted, with derivatives by
/// (w, v), the rotation exp(w) about the sensor and the translation v.
struct AlignmentSums {
    Vector6d gradient = Vector6d::Zero();
    Matrix6d information = Matrix6d::Zero();
    /// Of pairs that count alike, whatever their variances: the share of them that faces a
    /// direction.
    Matrix6d facing = Matrix6d::Zero();
    double weight = 0.0;  ///< of the kernel, of all pairs
    double nearby = 0.0;  ///< samples that lie on a surface [count]

    AlignmentSums& operator+=(const AlignmentSums& o);
};

/// The patches nearest to the samples, each within three deviations.
std::vector<SamplePair> pairWithPatches(const PatchTree<3>& target,
                                        const AlignmentSamples& samples,
                                        const Pose& T_target_sensor,
                                        const SearchRadius& deviation,
                                        const std::vector<SamplePair>& before);

/// @param kernel width of the robust kernel
AlignmentSums sumTerms(const PatchTree<3>& target, const AlignmentSamples& samples,
                       const std::vector<SamplePair>& pairs, const Pose& T_target_sensor,
                       const SearchRadius& kernel);

/// Sum over patches of the outer product of their gradient: how much the gradient would
/// scatter if the patches were drawn anew. Samples of one patch share its error.
Matrix6d scatterByPatch(const PatchTree<3>& target, const AlignmentSamples& samples,
                        const std::vector<SamplePair>& pairs, const Pose& T_target_sensor,
                        const SearchRadius& kernel);

}  // namespace hgmm
