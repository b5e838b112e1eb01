#include "registration/surface_alignment.h"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <unordered_set>

#include "registration/alignment_terms.h"
#include "registration/grazing_samples.h"

namespace hgmm {

namespace {

/// Samples lie within so many cells of the sensor along each axis.
constexpr double kMostCells = 1 << 20;
/// Least distance of a sensor's samples [m].
constexpr double kLeastRadius_m = 0.1;
/// Smallest edge of the grid that thins samples [m].
constexpr double kFinestThinning_m = 0.05;
/// A direction is held if more than this share of the pairs face it: what is below comes
/// from errors of normals.
constexpr double kHeldShare = 0.01;
/// Neighbouring samples and the errors of patches are alike: pairs count as no more than so
/// many independent ones.
constexpr double kIndependentPairs = 300.0;
/// Patches are chosen for being near, which hides part of their scatter.
constexpr double kHiddenPatchScatter = 1.5;
/// The last stage's kernel, besides the thickness of surfaces: that of the map's own
/// unevenness [m] and [rad].
constexpr SearchRadius kFinest{0.02, 0.001};
constexpr int kMaxStages = 8, kMaxStageIterations = 6, kMaxLastIterations = 12;
/// A stage ends when a step moves the samples by less than this share of the kernel.
constexpr double kSmallestStepShare = 0.05;
constexpr double kSmallestStep_m = 2e-4;

/// Directions of the pose that surfaces hold. They are found in the coordinates
/// (gyrationRadii w, v of the samples' centre), in which a rotation compares with a
/// translation.
class HeldDirections {
 public:
    HeldDirections(const AlignmentSums& sums, const Matrix6d& allowed,
                   const AlignmentSamples& samples,
                   const Eigen::Matrix3d& R_target_sensor) {
        const Eigen::Matrix3d radii =
            R_target_sensor * samples.gyrationRadii * R_target_sensor.transpose();
        const Eigen::Matrix3d lever = crossMatrix(R_target_sensor * samples.centre);
        Matrix6d toScaled = Matrix6d::Identity(), toPose = Matrix6d::Identity();
        toScaled.topLeftCorner<3, 3>() = radii;
        toScaled.bottomLeftCorner<3, 3>() = -lever;
        toPose.topLeftCorner<3, 3>() = radii.inverse();
        toPose.bottomLeftCorner<3, 3>() = lever * radii.inverse();
        const Matrix6d steps = allowed * toPose;
        const Eigen::SelfAdjointEigenSolver<Matrix6d> eigen(
            Matrix6d(steps.transpose() * sums.facing * steps));
        Matrix6d held = Matrix6d::Zero();
        for (int k = 0; k < 6; ++k) {
            if (!(eigen.eigenvalues()[k] > kHeldShare * sums.weight)) continue;
            const Vector6d axis = eigen.eigenvectors().col(k);
            held += axis * axis.transpose();
            ++count_;
        }
        projector_ = toPose * held * toScaled;
    }

    int count() const { return count_; }
    /// What the held directions know: an information by (w, v).
    Matrix6d restricted(const Matrix6d& information) const {
        return projector_.transpose() * information * projector_;
    }
    Vector6d restricted(const Vector6d& gradient) const {
        return projector_.transpose() * gradient;
    }

 private:
    Matrix6d projector_ = Matrix6d::Zero();
    int count_ = 0;
};

/// Projector on the directions in which a sensor may move, (w, v) in the target's axes.
Matrix6d allowedMotion(const AlignmentSamples& samples, const AlignmentPrior& prior) {
    if (!samples.planar) return Matrix6d::Identity();
    const Eigen::Vector3d n = prior.T_target_sensor.R * samples.planeNormal;
    Matrix6d allowed = Matrix6d::Zero();
    allowed.topLeftCorner<3, 3>() = n * n.transpose();
    allowed.bottomRightCorner<3, 3>() = Eigen::Matrix3d::Identity() - n * n.transpose();
    return allowed;
}

/// (w, v) from the prior's pose to another one.
Vector6d errorFrom(const Pose& prior, const Pose& T) {
    const Eigen::AngleAxisd turned(Eigen::Matrix3d(T.R * prior.R.transpose()));
    Vector6d error;
    error << turned.angle() * turned.axis(), T.t - prior.t;
    return error;
}

/// One alignment on its way.
class Aligner {
 public:
    Aligner(const PatchTree<3>& target, const AlignmentSamples& samples,
            const AlignmentPrior& prior)
        : target_(target),
          samples_(samples),
          prior_(prior),
          allowed_(allowedMotion(samples, prior)),
          priorInformation_(prior.covariance.inverse()) {
        result_.T_target_sensor = prior.T_target_sensor;
        result_.covariance = prior.covariance;
    }

    void runStage(const SearchRadius& kernel, int maxIterations) {
        const double enough_m = std::max(
            kSmallestStep_m, kSmallestStepShare * kernel.at(samples_.gyrationRadius_m));
        for (int k = 0; k < maxIterations; ++k) {
            const AlignmentSums sums = sumsAt(kernel);
            const HeldDirections held(sums, allowed_, samples_, result_.T_target_sensor.R);
            result_.observable = held.count();
            const double share = independentShare(sums);
            const Matrix6d information =
                share * held.restricted(sums.information) + priorInformation_;
            const Vector6d gradient =
                share * held.restricted(sums.gradient) +
                priorInformation_ *
                    errorFrom(prior_.T_target_sensor, result_.T_target_sensor);
            const Vector6d step = limited(-information.ldlt().solve(gradient));
            result_.T_target_sensor = {
                rotationOf(step.head<3>()) * result_.T_target_sensor.R,
                result_.T_target_sensor.t + step.tail<3>()};
            if (movedBy(step) < enough_m) break;
        }
    }

    /// Overlap and covariance at the end of the last stage.
    SurfaceAlignment finish(const SearchRadius& kernel) {
        const AlignmentSums sums = sumsAt(kernel);
        const HeldDirections held(sums, allowed_, samples_, result_.T_target_sensor.R);
        result_.observable = held.count();
        result_.overlap =
            samples_.size() == 0 ? 0.0 : sums.nearby / double(samples_.size());
        if (held.count() > 0) result_.covariance = posterior(sums, held, kernel);
        return result_;
    }

 private:
    /// How far a step moves the samples [m].
    double movedBy(const Vector6d& step) const {
        return std::hypot(step.head<3>().norm() * samples_.gyrationRadius_m,
                          step.tail<3>().norm());
    }
    /// No step goes farther than the prior may be off: beyond, surfaces say nothing.
    Vector6d limited(const Vector6d& step) const {
        const double most_m = prior_.deviation.at(samples_.gyrationRadius_m);
        const double moved_m = movedBy(step);
        return moved_m > most_m ? Vector6d(step * (most_m / moved_m)) : step;
    }
    AlignmentSums sumsAt(const SearchRadius& kernel) {
        pairs_ =
            pairWithPatches(target_, samples_, result_.T_target_sensor, kernel, pairs_);
        return sumTerms(target_, samples_, pairs_, result_.T_target_sensor, kernel);
    }

    static double independentShare(const AlignmentSums& sums) {
        return sums.weight > kIndependentPairs ? kIndependentPairs / sums.weight : 1.0;
    }

    /// The sandwich estimate, whose information joins the prior's.
    Matrix6d posterior(const AlignmentSums& sums, const HeldDirections& held,
                       const SearchRadius& kernel) const {
        const double few = 6.0 / std::max(sums.weight, 1.0);
        const Matrix6d scatter =
            kHiddenPatchScatter *
            (scatterByPatch(target_, samples_, pairs_, result_.T_target_sensor, kernel) +
             few * sums.information);
        const Matrix6d information = held.restricted(
            Matrix6d(sums.information * scatter.ldlt().solve(sums.information)));
        const Matrix6d joined = information + priorInformation_;
        return joined.ldlt().solve(Matrix6d::Identity());
    }

    const PatchTree<3>& target_;
    const AlignmentSamples& samples_;
    const AlignmentPrior& prior_;
    Matrix6d allowed_;
    Matrix6d priorInformation_;
    std::vector<SamplePair> pairs_;
    SurfaceAlignment result_;
};

}  // namespace

Matrix6d covarianceOf(const SearchRadius& deviation) {
    Vector6d variance;
    variance << Eigen::Vector3d::Constant(deviation.angle_rad * deviation.angle_rad),
        Eigen::Vector3d::Constant(deviation.width_m * deviation.width_m);
    return variance.asDiagonal();
}

AlignmentSamples::AlignmentSamples(const Mixture<3>& samples_sensor,
                                   const Eigen::Vector3d& normalOfRays_sensor,
                                   std::size_t most)
    : planar(!normalOfRays_sensor.isZero()), planeNormal(normalOfRays_sensor) {
    std::vector<std::size_t> kept;
    for (double cell_m = kFinestThinning_m;; cell_m *= M_SQRT2) {
        std::unordered_set<std::uint64_t> taken;
        kept.clear();
        for (std::size_t i = 0; i < samples_sensor.size() && kept.size() <= most; ++i) {
            std::uint64_t cell = 0;
            bool near = true;
            for (int d = 0; d < 3; ++d) {
                const double x = std::floor(double(samples_sensor.mean[d][i]) / cell_m);
                near = near && std::abs(x) < kMostCells;
                if (near) cell = (cell << 21) + std::uint64_t(std::int64_t(x + kMostCells));
            }
            if (near && taken.insert(cell).second) kept.push_back(i);
        }
        if (kept.size() <= most) break;
    }
    if (kept.empty()) return;
    grazing = areGrazing(samples_sensor, kept);
    Eigen::Matrix3d moments = Eigen::Matrix3d::Zero();
    for (const std::size_t i : kept) {
        const Gaussian<3> g = samples_sensor[i];
        mean.emplace_back(g.mean);
        covariance.emplace_back(g.covariance);
        centre += mean.back();
        moments += mean.back() * mean.back().transpose();
    }
    const double n = double(kept.size());
    centre /= n;
    gyrationRadius_m = std::max(kLeastRadius_m, std::sqrt(moments.trace() / n));
    gyrationRadii = gyrationRadiiOf(moments / n - centre * centre.transpose());
}

SurfaceAlignment alignToSurfaces(const PatchTree<3>& target,
                                 const AlignmentSamples& samples,
                                 const AlignmentPrior& prior) {
    Aligner aligner(target, samples, prior);
    SearchRadius kernel = prior.deviation;
    for (int stage = 1; stage < kMaxStages; ++stage) {
        if (!(kernel.width_m > kFinest.width_m || kernel.angle_rad > kFinest.angle_rad))
            break;
        aligner.runStage(kernel, kMaxStageIterations);
        kernel.width_m = std::max(kFinest.width_m, 0.5 * kernel.width_m);
        kernel.angle_rad = std::max(kFinest.angle_rad, 0.5 * kernel.angle_rad);
    }
    aligner.runStage(kFinest, kMaxLastIterations);
    return aligner.finish(kFinest);
}

}  // namespace hgmm
