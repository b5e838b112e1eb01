#pragma once
#include <Eigen/Core>
#include <memory>
#include <vector>

#include "hgmm/export.h"
#include "hgmm/mixture.h"
#include "hgmm/scan.h"

namespace hgmm {

/// How two mixtures are aligned (RegistrationTarget): how far off the guessed pose of the
/// source's frame may be, one standard deviation, and to what it is resolved in the last
/// stage. Stages between halve the wider span.
struct RegistrationParams {
    double coarseWidth_m = 0.5;    ///< error of the guess' position [m], >= fineWidth_m
    double coarseAngle_rad = 0.3;  ///< error of its rotation [rad], >= fineAngle_rad
    double fineWidth_m = 0.03;     ///< about the thickness of mapped surfaces [m], > 0
    double fineAngle_rad = 0.003;  ///< added to it times the distance [rad], > 0
    int maxStageIterations = 20;   ///< of each stage [count], >= 1
    double minOverlap = 0.1;  ///< share of the source that must be found [1], in [0, 1]

    /// Throws std::invalid_argument naming the field.
    HGMM_EXPORT void validate() const;
};

/// What alignment found.
struct Registration {
    /// Unaligned, as in Gaussian.
    using Covariance = Eigen::Matrix<double, 6, 6, Eigen::DontAlign>;

    Pose T_target_source;
    /// Of the error (w, v), rotation [rad] before translation [m], both in the axes of the
    /// target: truth = { exp(w) R, t + v }. Positive definite. Directions that the data do
    /// not constrain have the deviations kUnobservable_m and kUnobservable_rad. The
    /// identity times these where nothing was found.
    Covariance covariance = Covariance::Identity();
    bool converged = false;  ///< with at least minOverlap
    int iterations = 0;      ///< of all stages and candidates
    double overlap = 0.0;    ///< share of the source's components near a target's, [0, 1]
    double cost = 0.0;       ///< of the last stage, <= 0: see RegistrationTarget
};

constexpr double kUnobservable_m = 10.0;   ///< standard deviation [m]
constexpr double kUnobservable_rad = 1.0;  ///< standard deviation [rad]

/// A mixture made ready for others to be aligned with it, at a cost that does not depend on
/// its size: distribution to distribution (Stoyanov et al. 2012) in stages of falling
/// width, from many rotations about the source's frame, of which half are given up at each
/// stage.
///
/// Each stage minimises, over the pose (R, t),
///   - sum_ij w_i exp(-1/2 mu_ij^T (R S_i R^T + S'_j)^-1 mu_ij),  mu_ij = R m_i + t - m_j,
/// over each source component i, w_i being 1 / their number, and the target components j
/// next to it: what has no counterpart adds nothing. S'_j is S_j widened by the
/// stage's width across the component and, by the component's aspect, more along it (the
/// plane-to-plane idea of generalised ICP, Segal et al. 2009): a flat component holds the
/// source along its normal and lets it slide along the surface. All stages but the last add
/// a weak normal prior about the guess: more overlap alone would let the source slide away
/// from it.
///
/// Steps are Newton's with the full Hessian where it is positive definite, else with its
/// Gauss-Newton part, damped, no longer than the stage's width, and halved until the cost
/// does not rise. Directions that the target does not hold are left as they were guessed.
class HGMM_EXPORT RegistrationTarget {
 public:
    /// @param levels coarse to fine, or one; all in one frame, the target's. Copied: they
    /// may go afterwards. The last serves the finest stages. Components that are not finite
    /// are left out.
    /// Throws std::invalid_argument for params out of range, no level or a null pointer.
    explicit RegistrationTarget(const std::vector<const Mixture<3>*>& levels,
                                const RegistrationParams& params = {});
    RegistrationTarget(RegistrationTarget&&) noexcept;
    RegistrationTarget& operator=(RegistrationTarget&&) noexcept;
    ~RegistrationTarget();

    /// Aligns `source`, a mixture or the samples of a scan (filterScan), from a guess. The
    /// guess' rotation is taken to be off about the source's origin, as a sensor's is: a
    /// source far from its origin is off by as much more.
    /// Where nothing is found within reach the guess comes back, not converged. The result
    /// does not depend on the number of threads. Thread-safe. Throws std::invalid_argument
    /// for a guess that is not finite or whose rotation is not orthonormal to 1e-4.
    Registration align(const Mixture<3>& source, const Pose& T_target_source_guess) const;

 private:
    struct Impl;
    std::unique_ptr<const Impl> impl_;
};

/// The same for a single alignment: only the part of the target that the source may reach
/// is made ready.
HGMM_EXPORT Registration registerMixtures(
    const std::vector<const Mixture<3>*>& targetLevels, const Mixture<3>& source,
    const Pose& T_target_source_guess, const RegistrationParams& params = {});

}  // namespace hgmm
