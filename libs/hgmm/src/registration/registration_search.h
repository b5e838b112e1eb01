#pragma once
#include "hgmm/registration.h"
#include "registration/registration_layers.h"
#include "registration/registration_newton.h"

namespace hgmm {

struct SearchEnd {
    Pose T_target_centre;  ///< from the source's centred frame
    StageEnd last;         ///< of the finest stage
    int iterations = 0;    ///< of all stages and candidates
};

/// Widths of the stages, coarse to fine, in equal ratios of at least 1/2.
std::vector<SearchRadius> stagesOf(const RegistrationParams& params);

/// Rotation vectors on a cubic lattice, in a ball of coarseAngle_rad [rad].
std::vector<Eigen::Vector3d> rotationLattice(const RegistrationParams& params);

/// The source, last, and before it thinner ones with half as many components each, about,
/// as far as there are enough.
std::vector<RegistrationSource> thinnedSources(RegistrationSource source);

/// Successive halving (Karnin et al. 2013) of candidate poses: the guess turned, about the
/// source's frame, by each node of the lattice is rated with few components of the source;
/// the best are aligned, and each narrower stage has half as many of them and twice the
/// components. Does not depend on the number of threads.
/// @param source not empty
SearchEnd searchPose(const TargetLayers& target, const RegistrationParams& params,
                     const RegistrationSource& source, const Pose& T_target_source_guess);

}  // namespace hgmm
