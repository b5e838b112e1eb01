#pragma once
#include <Eigen/Core>
#include <functional>

/// Calls f with the centre of each voxel of 0.1 m within [low, high) [m].
inline void forVoxels(const Eigen::Vector3d& low, const Eigen::Vector3d& high,
                      const std::function<void(const Eigen::Vector3d&)>& f) {
    const Eigen::Array3i n = ((high - low) / 0.1).array().round().cast<int>();
    for (int i = 0; i < n.x(); ++i)
        for (int j = 0; j < n.y(); ++j)
            for (int k = 0; k < n.z(); ++k)
                f(low + 0.1 * Eigen::Vector3d(i, j, k) + Eigen::Vector3d::Constant(0.05));
}
