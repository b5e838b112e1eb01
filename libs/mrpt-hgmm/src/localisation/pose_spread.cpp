#include "localisation/pose_spread.h"

#include <algorithm>
#include <cmath>

namespace hgmm::mrpt_bridge {

namespace {

constexpr double kPerMetre = 1024, kPerUnit = 1 << 20;
/// Farther from the map's origin there is no map [m].
constexpr double kFarthest_m = 65536;

}  // namespace

void PoseSums::add(const Eigen::Vector3d& t, const Eigen::Matrix3d& R) {
    if (!t.allFinite() || !R.allFinite()) return;
    ++count_;
    for (int d = 0; d < 3; ++d) {
        const auto value = static_cast<std::uint64_t>(
            std::llround(std::clamp(t[d], -kFarthest_m, kFarthest_m) * kPerMetre));
        sum_[d] += value;
        sumOfSquares_[d] += value * value;
    }
    for (int k = 0; k < 9; ++k) rotation_[k] += std::llround(R.data()[k] * kPerUnit);
}

double PoseSums::squaredDistances() const {
    if (count_ == 0) return 0;
    double squares = 0;
    for (int d = 0; d < 3; ++d) {
        const auto mean = static_cast<std::uint64_t>(std::llround(
            double(static_cast<std::int64_t>(sum_[d])) / static_cast<double>(count_)));
        // Sum of (value - mean)^2, exact because it fits.
        squares += static_cast<double>(sumOfSquares_[d] - 2 * mean * sum_[d] +
                                       count_ * mean * mean);
    }
    return squares / (kPerMetre * kPerMetre);
}

double PoseSums::squaredAngles() const {
    if (count_ == 0) return 0;
    // For rotations by angles a about the mean, |R - mean R|^2 is 2 a^2 on average.
    double squaredNorm = 0;
    for (const std::int64_t sum : rotation_) {
        const double mean = static_cast<double>(sum) / kPerUnit / double(count_);
        squaredNorm += mean * mean;
    }
    return double(count_) * std::max(0.0, (3 - squaredNorm) / 2);
}

}  // namespace hgmm::mrpt_bridge
