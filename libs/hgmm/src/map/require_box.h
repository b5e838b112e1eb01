#pragma once
#include <Eigen/Geometry>
#include <stdexcept>
#include <string>

namespace hgmm {

/// Throws std::invalid_argument for a box that is empty or not finite.
inline void requireBox(const Eigen::AlignedBox3d& box, const std::string& caller) {
    if (!box.min().allFinite() || !box.max().allFinite())
        throw std::invalid_argument(caller + ": the box is not finite");
    if (box.isEmpty()) throw std::invalid_argument(caller + ": the box is empty");
}

}  // namespace hgmm
