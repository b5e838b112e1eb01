#!/usr/bin/env python3
"""Maps a simulated room and shows a slice of the map.

    PYTHONPATH=build/python /usr/bin/python3 examples/python/slice.py slice.png
"""
import sys

import matplotlib
import numpy

matplotlib.use("Agg")
from matplotlib import pyplot  # noqa: E402

import hgmm  # noqa: E402

# Boxes in the map frame, lowest and highest corners [m]: the room, and what stands in it.
ROOM = numpy.array([[-4, -3, 0], [4, 3, 2.5]], float)
FURNITURE = numpy.array([[[-3.9, -2.9, 0], [-3.3, -1.0, 1.9]],
                         [[1.0, 1.4, 0], [2.2, 2.2, 1.6]],
                         [[2.4, -2.2, 0], [3.0, -1.6, 1.4]],
                         [[-1.6, 1.5, 0], [-1.2, 1.9, 2.5]]])
HEIGHT = 1.0  # of the slice [m]


def crossings(box, origin, rays):
    """Distances at which rays enter and leave a box [m]."""
    with numpy.errstate(divide="ignore"):
        planes = (box[:, None, :] - origin) / rays
    return planes.min(axis=0).max(axis=1), planes.max(axis=0).min(axis=1)


def scan(pose, noise=0.005, seed=0):
    """Points that a lidar of 32 rings sees, in its own frame [m]."""
    elevation, azimuth = numpy.meshgrid(numpy.linspace(-0.5, 0.5, 32),
                                        numpy.linspace(-numpy.pi, numpy.pi, 720, endpoint=False))
    rays_sensor = numpy.stack([numpy.cos(elevation) * numpy.cos(azimuth),
                               numpy.cos(elevation) * numpy.sin(azimuth),
                               numpy.sin(elevation)], axis=-1).reshape(-1, 3)
    rays_map = rays_sensor @ pose[:3, :3].T
    _, ranges = crossings(ROOM, pose[:3, 3], rays_map)
    for box in FURNITURE:
        enter, leave = crossings(box, pose[:3, 3], rays_map)
        ranges = numpy.where((enter > 0) & (enter < leave), numpy.minimum(ranges, enter), ranges)
    ranges = ranges + noise * numpy.random.default_rng(seed).standard_normal(len(ranges))
    return rays_sensor * ranges[:, None]


def walk():
    """Poses of the lidar in the map, along an arc."""
    for i, angle in enumerate(numpy.linspace(0.2, numpy.pi - 0.2, 8)):
        pose = numpy.eye(4)
        pose[:2, :2] = [[numpy.cos(angle), -numpy.sin(angle)], [numpy.sin(angle), numpy.cos(angle)]]
        pose[:3, 3] = [2.2 * numpy.cos(angle), 0.4 - 1.2 * numpy.sin(angle), 1.2]
        yield i, pose


def show(room, poses, file):
    x, y = numpy.meshgrid(numpy.arange(-4.6, 4.6, 0.02), numpy.arange(-3.6, 3.6, 0.02))
    points = numpy.stack([x, y, numpy.full_like(x, HEIGHT)], axis=-1).reshape(-1, 3)
    answers = room.occupancy(points)
    # Occupied red, free white, unknown grey.
    shade = numpy.outer(answers.occupied, [0.75, 0.1, 0.1]) + \
        numpy.outer(answers.free, [1, 1, 1]) + numpy.outer(answers.unknown, [0.6, 0.6, 0.6])
    along_ray = room.along_ray(points).mean.reshape(x.shape)

    figure, axes = pyplot.subplots(1, 2, figsize=(12, 4.6), sharey=True, layout="constrained")
    extent = (x.min(), x.max(), y.min(), y.max())
    axes[0].imshow(shade.reshape(*x.shape, 3).clip(0, 1), origin="lower", extent=extent)
    axes[0].plot(*numpy.array([pose[:2, 3] for pose in poses]).T, "k.-", label="sensor")
    axes[0].legend(loc="lower right")
    axes[0].set_title(f"occupied (red), free (white), unknown (grey) at {HEIGHT:g} m")
    picture = axes[1].imshow(along_ray, origin="lower", extent=extent, cmap="viridis", vmin=0)
    axes[1].set_title("expected distance to the surface along the rays (white: not known)")
    figure.colorbar(picture, ax=axes[1], label="m")
    for axis in axes:
        axis.set_xlabel("x [m]")
    axes[0].set_ylabel("y [m]")
    figure.savefig(file, dpi=110)


def main():
    room = hgmm.Map(resolution_m=0.04)
    poses = []
    for seed, pose in walk():
        room.insert(scan(pose, seed=seed), pose)
        poses.append(pose)
    info = room.info()
    print(f"{len(poses)} scans, {info['points']:.0f} points: {room!r}, {info['saved_bytes']} bytes")
    hit = room.cast_ray([0, 0, 1.2], [1, 0, 0])
    print(f"a ray along x meets the wall at {hit.range:.3f} m")
    show(room, poses, sys.argv[1] if len(sys.argv) > 1 else "slice.png")


if __name__ == "__main__":
    main()
