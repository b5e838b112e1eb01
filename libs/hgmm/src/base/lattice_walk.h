#pragma once
#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>

#include "base/power_of_two.h"

namespace hgmm {

/// One axis of a walk along a segment through the cells of a lattice (Amanatides and Woo
/// 1987).
struct WalkAxis {
    std::int32_t cell = 0, step = 1;
    std::int64_t left = 0;  ///< steps to the last cell
    double delta = 0.0;     ///< share of the segment's length from cell to cell
    double next = std::numeric_limits<double>::infinity();  ///< where it leaves this one

    /// From a to b, in cells.
    WalkAxis(double a, double b) : cell(floorToInt(a)) {
        const std::int64_t way = std::int64_t{floorToInt(b)} - cell;
        if (way == 0) return;
        step = way < 0 ? -1 : 1;
        left = std::abs(way);
        delta = std::abs(1.0 / (b - a));
        next = delta * (way < 0 ? a - cell : cell + 1 - a);
    }
    void go() {
        cell += step;
        next = --left == 0 ? std::numeric_limits<double>::infinity() : next + delta;
    }
};

/// Whether a walk from a to b, in cells, is possible: ends are finite and the coordinates
/// of both sum up to less than 10^9.
inline bool canWalk(const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
    return a.cwiseAbs().sum() + b.cwiseAbs().sum() < 1e9;
}

/// Calls visit(cell, tIn, tOut) for each cell of a lattice that a segment passes, from one
/// end to the other. `cell` points to three coordinates; the segment is in the cell between
/// the shares tIn and tOut of its length. Nothing is visited where no walk is possible.
/// @param perCell cells per metre
template <typename Visit>
void walkCells(const Eigen::Vector3d& from, const Eigen::Vector3d& to, double perCell,
               Visit&& visit) {
    const Eigen::Vector3d a = from * perCell, b = to * perCell;
    if (!canWalk(a, b)) return;
    WalkAxis x(a[0], b[0]), y(a[1], b[1]), z(a[2], b[2]);
    double t = 0.0;
    for (std::int64_t steps = x.left + y.left + z.left; steps >= 0; --steps) {
        WalkAxis& xy = y.next < x.next ? y : x;
        WalkAxis& axis = z.next < xy.next ? z : xy;
        const double out = steps == 0 ? 1.0 : std::min(axis.next, 1.0);
        const std::int32_t cell[3] = {x.cell, y.cell, z.cell};
        visit(cell, t, out);
        t = out;
        axis.go();
    }
}

/// One axis of a walk through blocks of 4 x 4 x 4 cells, of which bit x + 4 y + 16 z stands
/// for the cell (x, y, z).
struct BlockWalkAxis {
    std::int32_t block, step;
    std::int32_t left;              ///< cells to the block's border
    unsigned inBlock, acrossBlock;  ///< what a step turns bits by
    double delta, next;

    /// @param stride bits from cell to cell along the axis
    BlockWalkAxis(const WalkAxis& axis, unsigned stride)
        : block(axis.cell >> 2), step(axis.step), delta(axis.delta), next(axis.next) {
        const std::int32_t local = axis.cell & 3;
        left = step > 0 ? 4 - local : local + 1;
        inBlock = step > 0 ? stride : 64 - stride;
        acrossBlock = step > 0 ? 64 - 3 * stride : 3 * stride;
    }
};

/// Calls visit(x, y, z, cells) for each block of 4 x 4 x 4 cells that a segment passes. A
/// block's coordinates are those of its cells / 4; bit x + 4 y + 16 z of `cells` says that
/// the segment passes the cell (x, y, z) in it. Nothing is visited where no walk is
/// possible.
/// @param perCell cells per metre
template <typename Visit>
void walkBlocks(const Eigen::Vector3d& from, const Eigen::Vector3d& to, double perCell,
                Visit&& visit) {
    const Eigen::Vector3d a = from * perCell, b = to * perCell;
    if (!canWalk(a, b)) return;
    const WalkAxis ax(a[0], b[0]), ay(a[1], b[1]), az(a[2], b[2]);
    BlockWalkAxis x(ax, 1), y(ay, 4), z(az, 16);
    std::uint64_t cell = std::uint64_t{1} << unsigned((ax.cell & 3) | (ay.cell & 3) << 2 |
                                                      (az.cell & 3) << 4);
    std::uint64_t cells = cell;
    const auto turn = [&](unsigned by) { cell = cell << by | cell >> (64U - by); };
    // Each axis by itself: so all stays in registers.
    const auto go = [&](BlockWalkAxis& axis) {
        axis.next += axis.delta;
        if (--axis.left == 0) return true;
        turn(axis.inBlock);
        cells |= cell;
        return false;
    };
    const auto cross = [&](BlockWalkAxis& axis) {
        turn(axis.acrossBlock);
        axis.block += axis.step;
        axis.left = 4;
    };
    for (std::int64_t steps = ax.left + ay.left + az.left;; cells = cell) {
        bool leaves = false;
        for (; steps > 0 && !leaves; --steps)
            leaves = y.next < x.next   ? z.next < y.next ? go(z) : go(y)
                       : z.next < x.next ? go(z)
                                       : go(x);
        visit(x.block, y.block, z.block, cells);
        if (!leaves) return;
        if (x.left == 0)
            cross(x);
        else
            y.left == 0 ? cross(y) : cross(z);
    }
}

}  // namespace hgmm
