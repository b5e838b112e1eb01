#pragma once
#include <Eigen/Core>
#include <array>
#include <cstdint>

namespace hgmm::mrpt_bridge {

/// How far poses are spread about their mean.
struct PoseSpread {
    double position_m = 0;    ///< standard deviation of the position, all axes together [m]
    double rotation_rad = 0;  ///< likewise of the rotation [rad]; about 1 if any heading is
};

/// Sums over poses from which their spread about the mean follows. They are integers: the
/// spread is the same to the last bit, whatever the order in which threads add poses. A
/// value below a millimetre counts nothing; it is exact for a million poses over
/// kilometres.
class PoseSums {
 public:
    /// Leaves out poses that are not finite.
    void add(const Eigen::Vector3d& t, const Eigen::Matrix3d& R);

    std::uint64_t count() const { return count_; }
    /// Sum of squared distances to the mean position [m^2].
    double squaredDistances() const;
    /// Sum of squared angles to the mean rotation [rad^2], about, for small angles.
    double squaredAngles() const;

 private:
    std::uint64_t count_ = 0;
    /// Modulo 2^64, so that far poses do no harm: the sum of squares about the mean is
    /// small.
    std::array<std::uint64_t, 3> sum_{}, sumOfSquares_{};
    std::array<std::int64_t, 9> rotation_{};
};

}  // namespace hgmm::mrpt_bridge
