#pragma once
#include <optional>
#include <vector>

#include "hgmm/scan.h"
#include "hgmm/tracker.h"
#include "registration/registration_cost.h"
#include "registration/registration_layers.h"

namespace hgmm {

/// Motion of a sensor in its own frame.
struct Velocity {
    Eigen::Vector3d angular = Eigen::Vector3d::Zero();  ///< [rad/s]
    Eigen::Vector3d linear = Eigen::Vector3d::Zero();   ///< [m/s]

    /// Of a motion that took so long [s], > 0.
    static Velocity of(const Pose& T_before_after, double duration_s);
    /// T_now_later.
    Pose after(double duration_s) const;
};

/// Rotation vector of R [rad].
Eigen::Vector3d rotationVector(const Eigen::Matrix3d& R);

/// Whether two poses are farther from each other than this, in position or rotation.
bool isFarFrom(const Pose& a, const Pose& b, const SearchRadius& most);

/// The nearest rotation to a product of many.
Eigen::Matrix3d orthonormal(const Eigen::Matrix3d& R);

/// Of a motion in the plane that holds all rays of a planar laser: others have hardly any
/// error. As it is where the normal is zero.
Registration::Covariance inPlaneOfRays(const Registration::Covariance& covariance,
                                       const Eigen::Vector3d& normalOfRays);

/// A pose moved on: errors of both add up.
PoseEstimate compose(const PoseEstimate& last, const MotionIncrement& motion);

/// The scan as it would have been, had all points been measured at once. Cleared rays stay.
Scan motionTakenOut(const Scan& scan, const std::vector<float>& pointTimes_s,
                    const Velocity& velocity);

/// How far priors are off, from how far they were: KISS-ICP's adaptive threshold (Vizzo et
/// al. 2023), for position and rotation apart.
class PriorDeviation {
 public:
    explicit PriorDeviation(const SearchRadius& first) : first_(first) {}

    SearchRadius now() const;
    void learn(const Pose& prior, const Pose& found);

    /// StateWriter, StateReader.
    template <typename Archive>
    void archive(Archive& a) {
        a(first_.width_m, first_.angle_rad, count_, squared_m2_, squared_rad2_);
    }

 private:
    SearchRadius first_;
    int count_ = 0;
    double squared_m2_ = 0.0, squared_rad2_ = 0.0;  ///< means of what was learnt
};

}  // namespace hgmm
