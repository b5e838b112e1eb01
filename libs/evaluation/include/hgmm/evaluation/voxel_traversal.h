#pragma once
#include <Eigen/Core>
#include <cmath>
#include <cstdlib>
#include <limits>

#include "hgmm/evaluation/voxel_hash.h"

namespace hgmm::evaluation {

/// Calls visit(cell) for each cell that the segment from one point to another passes, in
/// order, from that of `from` to the last before that of `to`, which is left out
/// (Amanatides and Woo, A fast voxel traversal algorithm, Eurographics 1987). Both must
/// have hasVoxel(). Neighbours in the sequence share a face; their number is the distance
/// of the first and last cell in steps along the axes, whatever the rounding.
template <class Visit>
void traverseVoxels(const Eigen::Vector3d& from_m, const Eigen::Vector3d& to_m,
                    double edge_m, Visit&& visit) {
    constexpr double kNever = std::numeric_limits<double>::infinity();
    VoxelIndex voxel = voxelOf(from_m, edge_m);
    const VoxelIndex last = voxelOf(to_m, edge_m);
    VoxelIndex left, step;
    Eigen::Vector3d next, period;  // share of the segment at the next border, and between
    for (int axis = 0; axis < 3; ++axis) {
        const double length = to_m[axis] - from_m[axis];
        left[axis] = std::abs(last[axis] - voxel[axis]);
        step[axis] = last[axis] > voxel[axis] ? 1 : -1;
        const double border_m = (voxel[axis] + (step[axis] > 0 ? 1 : 0)) * edge_m;
        // Axes whose steps are used up never come again: rounding cannot lead past the end.
        next[axis] = left[axis] > 0 ? (border_m - from_m[axis]) / length : kNever;
        period[axis] = left[axis] > 0 ? edge_m / std::abs(length) : kNever;
    }
    while (left.x() > 0 || left.y() > 0 || left.z() > 0) {
        visit(voxel);
        int axis = 0;
        next.minCoeff(&axis);
        voxel[axis] += step[axis];
        next[axis] = --left[axis] > 0 ? next[axis] + period[axis] : kNever;
    }
}

}  // namespace hgmm::evaluation
