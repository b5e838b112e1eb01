#!/usr/bin/env python3
"""How much of the walls of a planar map is double: the share of their length that has a second,
parallel wall .1 to .6 m beside it, with free space between. The two faces of a real wall have
unknown space between and do not count.

    scripts/wall_doubling.py MAP.yaml         as of hgmm-map export or map_server
    scripts/wall_doubling.py IMAGE METRES     a picture (dark is occupied), metres of a pixel

Prints the length of walls [m], that of double ones [m], and the share [%]. A pixel belongs to a
wall if it lies in a straight row of occupied ones 1 m long, much longer than wide; rows
may have gaps of a pixel or two. Walls are parallel within 15 deg.
"""

import os
import re
import sys

import numpy as np

LONG_M, NEAR_M, FAR_M = 1.0, 0.1, 0.6
HEADINGS = 32  # that walls are tried in, over half a turn
PARALLEL = np.cos(np.radians(15))
SLENDER = 2.5  # length of a wall's piece over its thickness
FREE_SHARE = 0.5  # of the gap


def read_pgm(path):
    data = open(path, "rb").read()
    head = re.match(rb"P5\s+(?:#.*\n\s*)*(\d+)\s+(\d+)\s+(\d+)\s", data)
    width, height = int(head[1]), int(head[2])
    return np.frombuffer(data, np.uint8, width * height, head.end()).reshape(height, width)


def read_map(arguments):
    """P(occupied) of each pixel, the limits of occupied and free, metres of a pixel."""
    if len(arguments) == 2:
        import matplotlib.image

        image = np.atleast_3d(matplotlib.image.imread(arguments[0]))[:, :, 0].astype(float)
        return 1 - image / (1.0 if image.max() <= 1 else 255.0), 0.65, 0.35, float(arguments[1])
    text = open(arguments[0]).read()
    field = lambda name: re.search(rf"^{name}:\s*(\S+)", text, re.M)[1]
    image = read_pgm(os.path.join(os.path.dirname(arguments[0]), field("image")))
    occupied = 1 - image / 255.0
    return occupied, *(float(field(f)) for f in ("occupied_thresh", "free_thresh", "resolution"))


def run_length(occupied, rows, columns, direction, most):
    """How far pixels are occupied without a gap, to both sides [pixels]."""
    length = np.ones(len(rows))
    for side in (1, -1):
        going = np.ones(len(rows), bool)
        for k in range(1, most + 1):
            y = np.rint(rows + side * k * direction[0]).astype(int)
            x = np.rint(columns + side * k * direction[1]).astype(int)
            inside = (y >= 0) & (y < occupied.shape[0]) & (x >= 0) & (x < occupied.shape[1])
            going &= inside
            going[going] = occupied[y[going], x[going]]
            length += going
    return length


def thickened(occupied):
    """With the eight neighbours of each pixel."""
    padded = np.pad(occupied, 1)
    wide = padded[:, :-2] | padded[:, 1:-1] | padded[:, 2:]
    return wide[:-2] | wide[1:-1] | wide[2:]


def wall_normals(occupied, metres):
    """Pixels of walls as rows and columns, and their unit normals."""
    rows, columns = np.nonzero(occupied)
    angles = np.arange(HEADINGS) * np.pi / HEADINGS
    headings = np.stack([np.sin(angles), np.cos(angles)], 1)
    most = round(LONG_M / metres)
    without_gaps = thickened(occupied)
    runs = np.array([run_length(without_gaps, rows, columns, h, most) for h in headings])
    longest = runs.argmax(0)
    pixel = np.arange(len(rows))
    across = runs[(longest + HEADINGS // 2) % HEADINGS, pixel]
    along = runs[longest, pixel]
    wall = (along * metres >= LONG_M) & (along >= SLENDER * across)
    normals = headings[(longest + HEADINGS // 2) % HEADINGS]
    return rows[wall], columns[wall], normals[wall]


def beside(start, normals, side, fields, metres):
    """Thickness of the wall towards a side [pixels], and whether there is a second one."""
    occupied, free, normal_at = fields
    step = 0.5
    n = len(start)
    left = np.zeros(n, bool)  # the wall
    ended, double = np.zeros(n, bool), np.zeros(n, bool)
    thickness, gap, gap_free = np.zeros(n), np.zeros(n), np.zeros(n)
    for distance in np.arange(step, FAR_M / metres + step / 2, step):
        at = np.rint(start + side * distance * normals).astype(int)
        inside = ((at >= 0) & (at < occupied.shape)).all(1)
        at = np.clip(at, 0, np.array(occupied.shape) - 1)
        hit = occupied[at[:, 0], at[:, 1]] & inside
        thickness += step * (hit & ~left)
        second = hit & left & ~ended
        parallel = np.abs((normal_at[at[:, 0], at[:, 1]] * normals).sum(1)) > PARALLEL
        double |= second & parallel & (distance * metres >= NEAR_M) & (gap_free >= FREE_SHARE * gap)
        ended |= second
        left |= ~hit
        gap += left & ~ended
        gap_free += left & ~ended & free[at[:, 0], at[:, 1]]
    return thickness, double


def main():
    if len(sys.argv) not in (2, 3):
        sys.exit(__doc__)
    probability, occupied_from, free_below, metres = read_map(sys.argv[1:])
    occupied, free = probability > occupied_from, probability < free_below
    rows, columns, normals = wall_normals(occupied, metres)
    if len(rows) == 0:
        sys.exit("wall_doubling.py: there are no walls")
    normal_at = np.zeros((*occupied.shape, 2))
    normal_at[rows, columns] = normals
    start = np.stack([rows, columns], 1).astype(float)
    fields = occupied, free, normal_at
    sides = [beside(start, normals, side, fields, metres) for side in (1, -1)]
    # A pixel stands for its share of the wall's thickness.
    length_m = metres / (1 + sides[0][0] + sides[1][0])
    double_m = length_m[sides[0][1] | sides[1][1]].sum()
    print(f"{length_m.sum():.1f} {double_m:.1f} {100 * double_m / length_m.sum():.2f}")


if __name__ == "__main__":
    main()
