#!/usr/bin/env python3
"""Simulates a lidar of 64 rings that drives through a hall, or outdoors among trees and cars.

    scripts/simulate_lidar64.py hall|outdoors FOLDER [--scans 30]

Writes one binary PCD a scan, in the frame of the sensor, and poses.txt, in TUM's format, for
`hgmm-import pcd FOLDER --poses FOLDER/poses.txt`. Ranges have 2 cm of noise, and one in 200 rays
ends in dust. A scan has about 78 000 points in the hall, and 38 000 up to 100 m outdoors.
"""
import argparse
import pathlib

import numpy

RINGS = 64
NOISE_M = 0.02
DUST = 0.005
MAX_RANGE_M = 100.0


def boxes_of_hall(random, _):
    """Corners [n, 2, 3] of pillars, crates and shelves in a hall of 60 x 40 x 8 m."""
    boxes = [((x - 0.3, y - 0.3, 0), (x + 0.3, y + 0.3, 8))
             for x in range(-24, 25, 12) for y in (-12, 12)]
    for _ in range(60):
        x, y = random.uniform(-28, 28), random.choice((-1, 1)) * random.uniform(3, 19)
        half, height = random.uniform(0.25, 1.0, 2), random.uniform(0.4, 2.0)
        boxes.append(((x - half[0], y - half[1], 0), (x + half[0], y + half[1], height)))
    for x in range(-25, 26, 5):
        for level in range(4):
            boxes.append(((x - 2, 16, level - 0.05), (x + 2, 17, level + 0.05)))
    return numpy.array(boxes, float)


def boxes_outdoors(random, places):
    """Corners [n, 2, 3] of cars, trunks and houses."""
    boxes = []
    for _ in range(40):
        x, y = random.uniform(-60, 80), random.choice((-1, 1)) * random.uniform(3.5, 12)
        boxes.append(((x - 2.2, y - 0.9, 0.2), (x + 2.2, y + 0.9, 1.5)))
    for x, y in places:
        boxes.append(((x - 0.2, y - 0.2, 0), (x + 0.2, y + 0.2, 4)))
    for k in range(8):
        x, side = -70 + 20 * k, (-1) ** k
        boxes.append(((x, side * 35 - 6, 0), (x + 14, side * 35 + 6, 9)))
    return numpy.array(boxes, float)


def trees(random):
    return [(random.uniform(-60, 80), random.choice((-1, 1)) * random.uniform(14, 26))
            for _ in range(50)]


def through_boxes(origin, directions, boxes):
    """Ranges to the nearest box [rays], infinite without one."""
    nearest = numpy.full(len(directions), numpy.inf)
    with numpy.errstate(divide="ignore", invalid="ignore"):
        inverse = 1 / directions
        for low, high in boxes:
            a, b = (low - origin) * inverse, (high - origin) * inverse
            enters, leaves = numpy.minimum(a, b).max(1), numpy.maximum(a, b).min(1)
            hits = (leaves >= enters) & (enters > 0)
            nearest[hits] = numpy.minimum(nearest[hits], enters[hits])
    return nearest


def inside_hall(origin, directions):
    with numpy.errstate(divide="ignore"):
        low, high = numpy.array((-30, -20, 0)), numpy.array((30, 20, 8))
        return numpy.maximum((low - origin) / directions, (high - origin) / directions).min(1)


def on_ground(origin, directions):
    with numpy.errstate(divide="ignore"):
        ranges = -origin[2] / directions[:, 2]
    return numpy.where(ranges > 0, ranges, numpy.inf)


def in_crowns(origin, directions, places, random):
    """Ranges at which rays end in crowns of 5 m, of which they pass 3 m on average."""
    nearest = numpy.full(len(directions), numpy.inf)
    for x, y in places:
        to = numpy.array((x, y, 6.0)) - origin
        along = directions @ to
        beside2 = to @ to - along ** 2
        half = numpy.sqrt(numpy.maximum(0, 2.5 ** 2 - beside2))
        depth = random.exponential(3.0, len(directions))
        hits = (beside2 < 2.5 ** 2) & (along > half) & (depth < 2 * half)
        nearest[hits] = numpy.minimum(nearest[hits], (along - half + depth)[hits])
    return nearest


def scan(scene, origin, yaw, boxes, places, random):
    """Points in the frame of the sensor [n, 3]."""
    low, high, steps = (-22.5, 22.5, 1220) if scene == "hall" else (-24.8, 2.0, 640)
    elevation = numpy.radians(numpy.linspace(low, high, RINGS))[None, :]
    azimuth = numpy.linspace(-numpy.pi, numpy.pi, steps, endpoint=False)[:, None]
    own = numpy.stack(numpy.broadcast_arrays(
        numpy.cos(elevation) * numpy.cos(azimuth), numpy.cos(elevation) * numpy.sin(azimuth),
        numpy.sin(elevation)), -1).reshape(-1, 3)
    turn = numpy.array(((numpy.cos(yaw), -numpy.sin(yaw), 0),
                        (numpy.sin(yaw), numpy.cos(yaw), 0), (0, 0, 1)))
    directions = own @ turn.T
    ranges = through_boxes(origin, directions, boxes)
    if scene == "hall":
        ranges = numpy.minimum(ranges, inside_hall(origin, directions))
    else:
        ranges = numpy.minimum(ranges, on_ground(origin, directions))
        ranges = numpy.minimum(ranges, in_crowns(origin, directions, places, random))
    dusty = random.uniform(size=len(ranges)) < DUST
    ranges[dusty] *= random.uniform(0.2, 1.0, dusty.sum())
    ranges += random.normal(0, NOISE_M, len(ranges))
    seen = (ranges > 0.5) & (ranges < MAX_RANGE_M)
    return own[seen] * ranges[seen, None]


def main():
    parser = argparse.ArgumentParser(description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("scene", choices=("hall", "outdoors"))
    parser.add_argument("folder", type=pathlib.Path)
    parser.add_argument("--scans", type=int, default=30)
    options = parser.parse_args()
    options.folder.mkdir(parents=True, exist_ok=True)
    random = numpy.random.default_rng(1)
    places = trees(random)
    boxes = (boxes_of_hall if options.scene == "hall" else boxes_outdoors)(random, places)
    poses = []
    for k in range(options.scans):
        origin, yaw = numpy.array((-8 + 0.5 * k, 0.3 * numpy.sin(0.2 * k), 1.8)), 0.02 * k
        points = scan(options.scene, origin, yaw, boxes, places, random).astype("<f4")
        header = (f"VERSION 0.7\nFIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nCOUNT 1 1 1\n"
                  f"WIDTH {len(points)}\nHEIGHT 1\nPOINTS {len(points)}\nDATA binary\n")
        (options.folder / f"{k:06d}.pcd").write_bytes(header.encode() + points.tobytes())
        poses.append(f"{k / 10:.1f} {origin[0]:.4f} {origin[1]:.4f} {origin[2]:.4f} "
                     f"0 0 {numpy.sin(yaw / 2):.8f} {numpy.cos(yaw / 2):.8f}\n")
    (options.folder / "poses.txt").write_text("".join(poses))


if __name__ == "__main__":
    main()
