#include "registration/registration_newton.h"

#include <Eigen/Cholesky>
#include <Eigen/Geometry>
#include <Eigen/Jacobi>
#include <algorithm>
#include <cmath>

namespace hgmm {

namespace {

/// A direction is observable if more than this share of the components face it: what is
/// below comes from the patches' bounds, not from surfaces.
constexpr double kObservableShare = 0.01;
/// A stage ends when a step moves the source by less than this share of the width.
constexpr double kSmallestStep = 0.01;
/// Neighbours are chosen for being near, which hides part of their scatter. The factor is
/// empirical: in simulated rooms the normalised error squared is 2.5 to 10 with it, of 6.
constexpr double kHiddenScatter = 1.5;
/// Standard deviations by which the best of several poses is better by chance.
constexpr double kChance = 2.0;
constexpr int kMaxHalvings = 6;
/// Levenberg's damping, as a share of the largest information.
constexpr double kDamping = 1e-4;

/// Turns a symmetric matrix into its diagonal of eigenvalues and returns the eigenvectors
/// (columns), by Jacobi's rotations.
Matrix6d diagonalise(Matrix6d& m) {
    constexpr int kMaxSweeps = 30;  // it takes about six
    Matrix6d vectors = Matrix6d::Identity();
    const double negligible = 1e-15 * m.trace();
    for (int sweep = 0; sweep < kMaxSweeps; ++sweep) {
        double largest = 0.0;
        for (int p = 0; p < 6; ++p) {
            for (int q = p + 1; q < 6; ++q) {
                largest = std::max(largest, std::abs(m(p, q)));
                Eigen::JacobiRotation<double> rotation;
                rotation.makeJacobi(m, p, q);
                m.applyOnTheLeft(p, q, rotation.adjoint());
                m.applyOnTheRight(p, q, rotation);
                vectors.applyOnTheRight(p, q, rotation);
            }
        }
        if (!(largest > negligible)) break;
    }
    return vectors;
}

/// The directions of the pose that the target constrains. Coordinates are
/// (gyrationRadii w, v): a rotation is scaled to the rms distance that it moves the
/// source's components, so that it compares with a translation.
class ObservableSubspace {
 public:
    ObservableSubspace(const CostSums& sums, const RegistrationSource& source,
                       const Eigen::Matrix3d& R_target_source) {
        const Eigen::Matrix3d gyrationRadii =
            R_target_source * source.gyrationRadii * R_target_source.transpose();
        unscale_.topLeftCorner<3, 3>() = gyrationRadii;
        scale_.topLeftCorner<3, 3>() = gyrationRadii.inverse();
        Matrix6d observability = scaled(sums.observability);
        const Matrix6d axes = diagonalise(observability);
        for (int k = 0; k < 6; ++k) {
            if (!(observability(k, k) > -kObservableShare * sums.cost)) continue;
            projector_ += axes.col(k) * axes.col(k).transpose();
            ++count_;
        }
        largest_ = projected(sums.gaussNewton, 0.0).norm();
    }

    int count() const { return count_; }
    /// As large as the largest information in a direction, or a little larger [1/m^2].
    double largest() const { return largest_; }
    /// Inverse of an information in these coordinates; zero in directions that are not
    /// observable.
    Matrix6d inverse(const Matrix6d& information) const {
        return projector_ * projected(information, largest_).ldlt().solve(projector_);
    }
    /// A matrix of second derivatives in these coordinates; `elsewhere` times the identity
    /// in directions that are not observable.
    Matrix6d projected(const Matrix6d& m, double elsewhere) const {
        return projector_ * scaled(m) * projector_ +
               elsewhere * (Matrix6d::Identity() - projector_);
    }
    /// A gradient in these coordinates.
    Vector6d projected(const Vector6d& v) const { return projector_ * scale_ * v; }
    /// The step that takes directions that are not observable to the minimum of a quadratic
    /// cost of that gradient and curvature by (w, v).
    Vector6d stepOutside(const CostSums& quadratic) const {
        const Matrix6d free = Matrix6d::Identity() - projector_;
        const Matrix6d curvature = free * scaled(quadratic.hessian) * free + projector_;
        const Vector6d slope = free * scale_ * quadratic.gradient;
        return step(-free * curvature.ldlt().solve(slope));
    }
    /// (w, v) of a step in these coordinates.
    Vector6d step(const Vector6d& v) const { return scale_ * v; }
    /// How far a step (w, v) moves the source's components, about [m].
    double lengthOf(const Vector6d& step) const { return (unscale_ * step).norm(); }
    /// Covariance of (w, v) from that in the observable directions; the others are unknown.
    Matrix6d covariance(const Matrix6d& observable) const {
        const Matrix6d unknown = unscale_ * unobservableCovariance() * unscale_;
        const Matrix6d free = Matrix6d::Identity() - projector_;
        return scaled(observable + free * unknown * free);
    }

 private:
    // Symmetric, as both factors are.
    Matrix6d scaled(const Matrix6d& m) const { return scale_ * m * scale_; }

    Matrix6d scale_ = Matrix6d::Identity(), unscale_ = Matrix6d::Identity();
    Matrix6d projector_ = Matrix6d::Zero();
    double largest_ = 0.0;
    int count_ = 0;
};

Pose moved(const Pose& T, const Vector6d& step) {
    return {rotationOf(step.head<3>()) * T.R, T.t + step.tail<3>()};
}

/// Newton's step in the observable directions, no longer than the stage's width.
Vector6d newtonStep(const CostSums& sums, const ObservableSubspace& observable,
                    double width_m) {
    const double largest = observable.largest();
    const Matrix6d damping = kDamping * largest * Matrix6d::Identity();
    Eigen::LLT<Matrix6d> curvature(observable.projected(sums.hessian, largest) + damping);
    if (curvature.info() != Eigen::Success)
        curvature.compute(observable.projected(sums.gaussNewton, largest) + damping);
    const Vector6d step =
        observable.step(-curvature.solve(observable.projected(sums.gradient)));
    const double length_m = observable.lengthOf(step);
    return length_m > width_m ? Vector6d(step * (width_m / length_m)) : step;
}

/// Whether the costs of all components differ by no more than what counts as nothing, or
/// than they would by chance.
bool isAsGood(const std::vector<double>& there, const std::vector<double>& here) {
    double more = 0.0, scatter = 0.0, matched = 0.0;
    for (std::size_t i = 0; i < here.size(); ++i) {
        const double difference = there[i] - here[i];
        more += difference;
        scatter += difference * difference;
        matched -= here[i];
    }
    return more <= std::max(kObservableShare * matched, kChance * std::sqrt(scatter));
}

}  // namespace

Vector6d PosePrior::normalisedError(const Pose& T) const {
    const Eigen::AngleAxisd turned(
        Eigen::Matrix3d(T.R * T_target_source_guess.R.transpose()));
    Vector6d error;
    error << turned.angle() / deviation.angle_rad * turned.axis(),
        (T.t - T.R * centre - T_target_source_guess.t) / deviation.width_m;
    return error;
}

double PosePrior::cost(const Pose& T_target_centre) const {
    return weight > 0.0 ? 0.5 * weight * normalisedError(T_target_centre).squaredNorm()
                        : 0.0;
}

void PosePrior::addTo(CostSums& sums, const Pose& T_target_centre) const {
    if (!(weight > 0.0)) return;
    const Vector6d error = normalisedError(T_target_centre);
    // A turn w about the source's centre moves its frame by w x (-R centre).
    Matrix6d J = Matrix6d::Zero();
    J.topLeftCorner<3, 3>() = Eigen::Matrix3d::Identity() / deviation.angle_rad;
    J.bottomLeftCorner<3, 3>() =
        crossMatrix(T_target_centre.R * centre) / deviation.width_m;
    J.bottomRightCorner<3, 3>() = Eigen::Matrix3d::Identity() / deviation.width_m;
    const Matrix6d curvature = weight * J.transpose() * J;
    sums.cost += 0.5 * weight * error.squaredNorm();
    sums.gradient += weight * J.transpose() * error;
    sums.hessian += curvature;
    sums.gaussNewton += curvature;
}

StageEnd runStage(const TargetLayers& target, const SearchRadius& searchRadius,
                  const RegistrationSource& source, const PosePrior& prior,
                  Pose& T_target_centre, int maxIterations) {
    const double width_m = searchRadius.at(source.gyrationRadius_m),
                 smallest_m = kSmallestStep * width_m;
    StageEnd end;
    while (end.iterations < maxIterations && !end.converged) {
        const auto neighbours = target.associate(source, searchRadius, T_target_centre);
        end.overlap = source.shareOf(neighbours);
        CostSums sums = target.sums(source, neighbours, T_target_centre);
        end.cost = source.size() == 0 ? 0.0 : sums.cost / double(source.size());
        if (!(sums.cost < 0.0)) return end;
        const ObservableSubspace observable(sums, source, T_target_centre.R);
        if (observable.count() == 0) return end;
        prior.addTo(sums, T_target_centre);
        ++end.iterations;

        Vector6d step = newtonStep(sums, observable, width_m);
        for (int halvings = 0;; ++halvings, step *= 0.5) {
            if (observable.lengthOf(step) < smallest_m || halvings > kMaxHalvings) {
                end.converged = true;
                break;
            }
            const Pose T_next = moved(T_target_centre, step);
            const double cost =
                target.cost(source, neighbours, T_next) + prior.cost(T_next);
            if (!(cost < sums.cost)) continue;
            T_target_centre = T_next;
            break;
        }
    }
    return end;
}

void remapDegenerate(const TargetLayers& target, const SearchRadius& searchRadius,
                     const RegistrationSource& source, const PosePrior& prior,
                     Pose& T_target_centre) {
    const auto neighbours = target.associate(source, searchRadius, T_target_centre);
    const CostSums sums = target.sums(source, neighbours, T_target_centre);
    const ObservableSubspace observable(sums, source, T_target_centre.R);
    if (observable.count() == 0 || observable.count() == 6) return;
    CostSums quadratic;
    prior.addTo(quadratic, T_target_centre);
    const Pose T_back = moved(T_target_centre, observable.stepOutside(quadratic));
    const auto there =
        target.costs(source, target.associate(source, searchRadius, T_back), T_back);
    if (isAsGood(there, target.costs(source, neighbours, T_target_centre)))
        T_target_centre = T_back;
}

Matrix6d poseCovariance(const TargetLayers& target, const SearchRadius& searchRadius,
                        const RegistrationSource& source, const Pose& T_target_centre) {
    const auto neighbours = target.associate(source, searchRadius, T_target_centre);
    const CostSums sums = target.sums(source, neighbours, T_target_centre);
    const ObservableSubspace observable(sums, source, T_target_centre.R);
    if (!(sums.cost < 0.0) || observable.count() == 0) return unobservableCovariance();
    // Few components underestimate their scatter. Adding that of six more, one for each
    // unknown, as the cost itself expects it, keeps the result positive definite.
    const double matched = std::max(-sums.cost, 1.0);
    const Matrix6d scatter = observable.projected(
        Matrix6d(target.gradientScatter(source, neighbours, T_target_centre) +
                 (6.0 / matched) * sums.gaussNewton),
        0.0);
    const Matrix6d inverse = observable.inverse(sums.gaussNewton);
    return observable.covariance(kHiddenScatter * inverse * scatter * inverse);
}

Matrix6d unobservableCovariance() {
    Vector6d variance;
    variance << Eigen::Vector3d::Constant(kUnobservable_rad * kUnobservable_rad),
        Eigen::Vector3d::Constant(kUnobservable_m * kUnobservable_m);
    return variance.asDiagonal();
}

}  // namespace hgmm
