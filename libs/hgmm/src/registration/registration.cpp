#include "hgmm/registration.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "base/require_rigid.h"
#include "hgmm/params.h"
#include "registration/registration_layers.h"
#include "registration/registration_newton.h"
#include "registration/registration_search.h"

namespace hgmm {

namespace {

/// The widest layer, for components far from the centre, in coarse widths.
constexpr double kFarWidths = 8.0;
/// A coarser level with less is too coarse to hold a pose.
constexpr std::size_t kFewestInLevel = 200;

void requireLevels(const std::vector<const Mixture<3>*>& levels) {
    if (levels.empty()) throw std::invalid_argument("registration: no target level");
    for (const Mixture<3>* level : levels)
        if (level == nullptr)
            throw std::invalid_argument("registration: a target level is null");
}

/// The covariance of a pose about the source's centre as one about its origin:
/// t = t_centre - R centre, so that v = v_centre + w x (-R centre).
Registration::Covariance aboutOrigin(const Matrix6d& covariance,
                                     const Eigen::Vector3d& centre_target) {
    Matrix6d J = Matrix6d::Identity();
    J.bottomLeftCorner<3, 3>() = crossMatrix(centre_target);
    return J * covariance * J.transpose();
}

/// Components of a mixture within three standard deviations of a ball.
Mixture<3> near(const Mixture<3>& mixture, const Eigen::Vector3d& centre, double radius_m) {
    Mixture<3> kept;
    for (std::size_t i = 0; i < mixture.size(); ++i) {
        const Gaussian<3> g = mixture[i];
        const double reach_m = radius_m + 3.0 * std::sqrt(g.covariance.trace());
        if ((g.mean - centre).squaredNorm() <= reach_m * reach_m) kept.pushBack(g);
    }
    return kept;
}

}  // namespace

void RegistrationParams::validate() const {
    requireInRange("fineWidth_m", fineWidth_m, 1e-3, 1e3);
    requireInRange("coarseWidth_m", coarseWidth_m, fineWidth_m, 1e3);
    requireInRange("fineAngle_rad", fineAngle_rad, 1e-5, 1.0);
    requireInRange("coarseAngle_rad", coarseAngle_rad, fineAngle_rad, 1.0);
    requireInRange("maxStageIterations", maxStageIterations, 1, 1e6);
    requireInRange("minOverlap", minOverlap, 0.0, 1.0);
}

struct RegistrationTarget::Impl {
    RegistrationParams params;
    TargetLayers layers;
};

RegistrationTarget::RegistrationTarget(const std::vector<const Mixture<3>*>& levels,
                                       const RegistrationParams& params) {
    params.validate();
    requireLevels(levels);
    auto impl = std::make_unique<Impl>();
    impl->params = params;
    // Layers an octave apart, each of the next coarser level as long as that has detail.
    std::size_t level = levels.size() - 1;
    auto shapes = std::make_unique<Shapes>(*levels[level]);
    const double widest_m = params.coarseWidth_m * kFarWidths;
    for (double width_m = params.fineWidth_m;; width_m *= 2.0) {
        impl->layers.push(*shapes, width_m);
        if (width_m >= widest_m) break;
        if (level == 0 || levels[level - 1]->size() < kFewestInLevel) continue;
        shapes = std::make_unique<Shapes>(*levels[--level]);
    }
    impl_ = std::move(impl);
}

RegistrationTarget::RegistrationTarget(RegistrationTarget&&) noexcept = default;
RegistrationTarget& RegistrationTarget::operator=(RegistrationTarget&&) noexcept = default;
RegistrationTarget::~RegistrationTarget() = default;

Registration RegistrationTarget::align(const Mixture<3>& mixture,
                                       const Pose& T_target_source_guess) const {
    requireRigid(T_target_source_guess, "registration: the guess");
    const RegistrationParams& params = impl_->params;
    const RegistrationSource source(mixture);
    Registration result;
    result.T_target_source = T_target_source_guess;
    result.covariance = unobservableCovariance();
    const SearchEnd found =
        searchPose(impl_->layers, params, source, T_target_source_guess);
    const StageEnd& end = found.last;
    result.iterations = found.iterations;
    if (end.overlap == 0.0) return result;

    result.overlap = end.overlap;
    result.cost = end.cost;
    result.converged = end.converged && end.overlap >= params.minOverlap;
    const Pose& T = found.T_target_centre;
    const Eigen::Vector3d centre_target = T.R * source.centre;
    result.T_target_source = {T.R, T.t - centre_target};
    result.covariance = aboutOrigin(
        poseCovariance(impl_->layers, stagesOf(params).back(), source, T), centre_target);
    return result;
}

Registration registerMixtures(const std::vector<const Mixture<3>*>& targetLevels,
                              const Mixture<3>& source, const Pose& T_target_source_guess,
                              const RegistrationParams& params) {
    params.validate();
    requireLevels(targetLevels);
    requireRigid(T_target_source_guess, "registration: the guess");
    const RegistrationSource components(source);
    double radius2 = 0.0;
    for (const Eigen::Vector3d& m : components.mean)
        radius2 = std::max(radius2, m.squaredNorm());
    // The guess may be off by a few widths, and turned about the source's frame.
    const double radius_m = 1.2 * std::sqrt(radius2) +
                            3.0 * params.coarseWidth_m * kFarWidths +
                            params.coarseAngle_rad * components.centre.norm();
    const Eigen::Vector3d centre =
        T_target_source_guess.R * components.centre + T_target_source_guess.t;
    std::vector<Mixture<3>> levels;
    for (const Mixture<3>* level : targetLevels)
        levels.push_back(near(*level, centre, radius_m));
    std::vector<const Mixture<3>*> pointers;
    for (const Mixture<3>& level : levels) pointers.push_back(&level);
    return RegistrationTarget(pointers, params).align(source, T_target_source_guess);
}

}  // namespace hgmm
