#pragma once
#include "hgmm/registration.h"
#include "registration/registration_cost.h"
#include "registration/registration_layers.h"

namespace hgmm {

/// What is known of the pose before: that of the source's frame is normal about a guess,
/// and weighs as `weight` components do.
struct PosePrior {
    /// weight / 2 of the squared normalised distance from the guess.
    double cost(const Pose& T_target_centre) const;
    /// Adds cost, gradient and curvature (Gauss-Newton's) to those of pairs.
    void addTo(CostSums& sums, const Pose& T_target_centre) const;

    Pose T_target_source_guess;
    Eigen::Vector3d centre = Eigen::Vector3d::Zero();  ///< of the source, in its frame
    SearchRadius deviation;  ///< standard ones, of position [m] and rotation [rad]
    double weight = 0.0;

 private:
    Vector6d normalisedError(const Pose& T_target_centre) const;
};

struct StageEnd {
    bool converged = false;
    int iterations = 0;
    double overlap = 0.0;  ///< share of the source's support that found a neighbour
    double cost = 0.0;     ///< divided by the number of source components
};

/// Minimises a stage's cost and the prior's from T_target_centre, which follows.
StageEnd runStage(const TargetLayers& target, const SearchRadius& searchRadius,
                  const RegistrationSource& source, const PosePrior& prior,
                  Pose& T_target_centre, int maxIterations);

/// Takes directions that the target does not hold back to where the prior is highest,
/// unless the cost says, beyond chance, that it does hold them.
void remapDegenerate(const TargetLayers& target, const SearchRadius& searchRadius,
                     const RegistrationSource& source, const PosePrior& prior,
                     Pose& T_target_centre);

/// Covariance of (w, v), about the source's centre, at the minimum of a stage: inverse
/// Hessian on both sides of the scatter of the gradient (the "sandwich" of M-estimation),
/// which needs neither units for the cost nor a model of the noise.
Matrix6d poseCovariance(const TargetLayers& target, const SearchRadius& searchRadius,
                        const RegistrationSource& source, const Pose& T_target_centre);

/// Of a pose of which nothing is known.
Matrix6d unobservableCovariance();

}  // namespace hgmm
