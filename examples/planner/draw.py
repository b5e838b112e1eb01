#!/usr/bin/env python3
"""Draws the paths that `plan` wrote over a slice of the map.

    PYTHONPATH=build/python /usr/bin/python3 examples/planner/draw.py map.hgmm path.csv path.png
"""
import argparse

import matplotlib
import numpy

matplotlib.use("Agg")
from matplotlib import pyplot  # noqa: E402

import hgmm  # noqa: E402

# Cuts: the axis across, and the two in the picture.
CUTS = {"z": (2, 0, 1), "y": (1, 0, 2)}
NEAR = 0.2  # a cut: paths are drawn bold there [m]


def read_paths(file):
    """Places of each plan in the map [m]."""
    table = numpy.atleast_2d(numpy.loadtxt(file, delimiter=",", skiprows=1))
    return [table[table[:, 0] == plan, 1:] for plan in numpy.unique(table[:, 0])]


def draw_cut(axes, room, paths, radius, cut, at):
    """The map where the axis across is `at`, and paths with the robot on them [m]."""
    across, right, up = CUTS[cut]
    surfaces = room.mixture().mean
    low, high = surfaces.min(axis=0) - 0.3, surfaces.max(axis=0) + 0.3
    step = max(high[right] - low[right], high[up] - low[up]) / 900
    grid = numpy.meshgrid(numpy.arange(low[right], high[right], step),
                          numpy.arange(low[up], high[up], step))
    points = numpy.empty((grid[0].size, 3))
    points[:, across], points[:, right], points[:, up] = at, grid[0].ravel(), grid[1].ravel()
    answers = room.occupancy(points)
    shade = numpy.outer(answers.occupied, [0.75, 0.1, 0.1]) + \
        numpy.outer(answers.free, [1, 1, 1]) + numpy.outer(answers.unknown, [0.7, 0.7, 0.7])
    axes.imshow(shade.reshape(*grid[0].shape, 3).clip(0, 1), origin="lower",
                extent=(low[right], high[right], low[up], high[up]))
    for path in paths:
        near = numpy.abs(path[:, across] - at) < NEAR
        line, = axes.plot(path[:, right], path[:, up], linewidth=1, linestyle=":")
        color = line.get_color()
        axes.plot(*numpy.where(near, path[:, [right, up]].T, numpy.nan), color=color, linewidth=2)
        for place in path[near]:
            axes.add_patch(pyplot.Circle(place[[right, up]], radius, color=color, alpha=0.15,
                                         linewidth=0))
        axes.plot(*path[0, [right, up]], "o", color=color, markersize=5)
        axes.plot(*path[-1, [right, up]], "s", color=color, markersize=5)
    axes.set_title(f"cut at {cut} = {at:.2f} m")
    axes.set_xlabel(f"{'xyz'[right]} [m]")
    axes.set_ylabel(f"{'xyz'[up]} [m]")


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("map")
    parser.add_argument("paths", help="CSV of plan -o")
    parser.add_argument("picture")
    parser.add_argument("--radius", type=float, default=0.0, help="of the robot [m]")
    parser.add_argument("--plan", type=int, help="only this one")
    arguments = parser.parse_args()
    room = hgmm.Map.load(arguments.map)
    paths = read_paths(arguments.paths)
    if arguments.plan is not None:
        paths = [paths[arguments.plan]]
    middle = numpy.median(numpy.concatenate(paths), axis=0)
    flat = max(numpy.ptp(path[:, 2]) for path in paths) == 0
    cuts = ["z"] if flat else ["z", "y"]
    figure, axes = pyplot.subplots(1, len(cuts), figsize=(7 * len(cuts), 6 if flat else 4.2),
                                   squeeze=False, layout="constrained")
    for cut, one in zip(cuts, axes[0]):
        draw_cut(one, room, paths, arguments.radius, cut, middle[CUTS[cut][0]])
    figure.suptitle("occupied red, free white, unknown grey; dot: start, square: goal; "
                    + ("" if flat else "\n")
                    + ("robot in colour" if flat else f"bold within {NEAR} m of the cut"),
                    fontsize="medium")
    figure.savefig(arguments.picture, dpi=80)


if __name__ == "__main__":
    main()
