#!/usr/bin/env python3
"""Says how near paths of `plan` come to the points that a map was made from.

A point with fewer than 5 of them around it, itself included, may be dust, a reflection or something
that went by: the second count leaves such points out. Exit code 1 if it is not zero.

    hgmm-replay log.rawlog --poses log.tum --report out/
    /usr/bin/python3 examples/planner/raw_clearance.py path.csv out/input.ply --radius 0.1
"""
import argparse
import sys

import numpy

from draw import read_paths

AROUND = 0.15  # a point [m]


def read_points(file):
    """Points of the binary .ply that `hgmm-replay --report` writes [m]."""
    with open(file, "rb") as ply:
        content = ply.read()
    begin = content.index(b"end_header\n") + len(b"end_header\n")
    if b"property double x\nproperty double y\nproperty double z\nend_header" not in content[:begin]:
        raise ValueError(f"{file}: not points of three doubles")
    return numpy.frombuffer(content[begin:], "<f8").reshape(-1, 3)


def distances(path, points):
    """From each point to the path's nearest segment [m]: exact, by brute force."""
    least = numpy.full(len(points), numpy.inf)
    for begin, end in zip(path[:-1], path[1:]):
        along = end - begin
        share = (points - begin) @ along / max(along @ along, 1e-30)
        nearest = begin + numpy.clip(share, 0, 1)[:, None] * along
        least = numpy.minimum(least, numpy.linalg.norm(points - nearest, axis=1))
    return least


def on_surface(point, points):
    """Whether as many points are around one as hgmm::kSurfaceSupport asks for."""
    return numpy.count_nonzero(numpy.linalg.norm(points - point, axis=1) < AROUND) >= 5


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("paths", help="CSV of plan -o")
    parser.add_argument("points", help="input.ply of hgmm-replay --report")
    parser.add_argument("--radius", type=float, required=True, help="of the robot [m]")
    arguments = parser.parse_args()
    points = read_points(arguments.points)
    clear = True
    print(f"{len(points)} points\nplan  nearest_m  within the radius  on surfaces")
    for i, path in enumerate(read_paths(arguments.paths)):
        away = distances(path, points)
        within = points[away < arguments.radius]
        surfaces = sum(on_surface(point, points) for point in within)
        clear = clear and surfaces == 0
        print(f"{i:4d}  {away.min():9.3f}  {len(within):17d}  {surfaces:11d}")
    return 0 if clear else 1


if __name__ == "__main__":
    sys.exit(main())
