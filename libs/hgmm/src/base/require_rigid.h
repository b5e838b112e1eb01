#pragma once
#include <Eigen/LU>
#include <stdexcept>
#include <string>

#include "hgmm/scan.h"

namespace hgmm {

/// Throws std::invalid_argument, saying of what (`owner`, such as "Scan: the sensor pose"),
/// if a pose is not finite, farther than kMaxPosition_m, or its rotation not orthonormal to
/// 1e-4.
inline void requireRigid(const Pose& pose, const std::string& owner) {
    if (!pose.R.allFinite() || !pose.t.allFinite())
        throw std::invalid_argument(owner + " is not finite");
    if (!(pose.t.cwiseAbs().maxCoeff() <= kMaxPosition_m))
        throw std::invalid_argument(owner + " is farther than 1e8 m from the origin");
    if (!(pose.R * pose.R.transpose()).isIdentity(1e-4) || pose.R.determinant() < 0)
        throw std::invalid_argument(owner + "'s rotation is not orthonormal");
}

}  // namespace hgmm
