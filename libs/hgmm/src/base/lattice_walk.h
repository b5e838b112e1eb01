#pragma once
#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>

#include "base/power_of_two.h"

namespace hgmm {

/// Calls visit(cell, tIn, tOut) for each cell of a lattice that a segment passes, from one
/// end to the other (Amanatides and Woo 1987). `cell` points to three coordinates; the
/// segment is in the cell between the shares tIn and tOut of its length. Nothing is visited
/// if an end is not finite, or the coordinates of both sum up to more than 10^9 cells.
/// @param perCell cells per metre
template <typename Visit>
void walkCells(const Eigen::Vector3d& from, const Eigen::Vector3d& to, double perCell,
               Visit&& visit) {
    constexpr double kLimit = 1e9, kUnreached = std::numeric_limits<double>::infinity();
    const Eigen::Vector3d a = from * perCell, b = to * perCell;
    if (!(a.cwiseAbs().sum() + b.cwiseAbs().sum() < kLimit)) return;
    std::int32_t cell[3], step[3];
    double next[3], delta[3];
    std::int64_t left[3], steps = 0;
    for (int d = 0; d < 3; ++d) {
        cell[d] = floorToInt(a[d]);
        const std::int64_t way = std::int64_t{floorToInt(b[d])} - cell[d];
        step[d] = way < 0 ? -1 : 1;
        left[d] = std::abs(way);
        steps += left[d];
        delta[d] = std::abs(1.0 / (b[d] - a[d]));
        next[d] = left[d] == 0 ? kUnreached
                               : delta[d] * (way < 0 ? a[d] - cell[d] : cell[d] + 1 - a[d]);
    }
    double t = 0.0;
    for (; steps > 0; --steps) {
        int axis = next[1] < next[0] ? 1 : 0;
        if (next[2] < next[axis]) axis = 2;
        const double out = std::min(next[axis], 1.0);
        visit(cell, t, out);
        t = out;
        cell[axis] += step[axis];
        next[axis] = --left[axis] == 0 ? kUnreached : next[axis] + delta[axis];
    }
    visit(cell, t, 1.0);
}

}  // namespace hgmm
