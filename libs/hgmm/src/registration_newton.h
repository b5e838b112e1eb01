#pragma once
#include "hgmm/registration.h"
#include "registration_cost.h"
#include "registration_layers.h"

namespace hgmm {

struct StageEnd {
    bool converged = false;
    int iterations = 0;
    double overlap = 0.0;  ///< share of the source's support that found a neighbour
    double cost = 0.0;     ///< divided by the number of source components
};

/// Minimises a stage's cost from T_target_centre, which follows.
StageEnd runStage(const TargetLayers& target, const Reach& reach,
                  const RegistrationSource& source, Pose& T_target_centre,
                  int maxIterations);

/// Covariance of (w, v), about the source's centre, at the minimum of a stage: inverse
/// Hessian on both sides of the scatter of the gradient (the "sandwich" of M-estimation),
/// which needs neither units for the cost nor a model of the noise.
Matrix6d poseCovariance(const TargetLayers& target, const Reach& reach,
                        const RegistrationSource& source, const Pose& T_target_centre);

/// Of a pose of which nothing is known.
Matrix6d unobservableCovariance();

}  // namespace hgmm
