#!/usr/bin/env python3
"""Atlases of a recording of the benchmark: same bytes for 1, 2 and 3 workers, in shuffled order,
and with a worker that is killed; how good the merged map is beside that of one run; what it costs.

    scripts/atlas.py LOG.rawlog POSES.tum SCANS_FOLDER [WORK_FOLDER]

SCANS_FOLDER holds the clouds, %06d.pcd as POSES has lines, in the frame of the poses. PYTHONPATH
and PATH lead to the package hgmm and to hgmm-replay. Fails if anything is not as it must be.
"""
import os
import pathlib
import random
import signal
import subprocess
import sys
import tempfile
import time
from dataclasses import replace

import numpy
from distributed import Client, LocalCluster

import hgmm
from hgmm.atlas import Atlas, plan, run
from hgmm.atlas.files import Folder
from hgmm.atlas.tasks import count_scans

SEGMENTS = 8
SPLIT = 10
RAY_ORIGIN = numpy.array([0.0417, 0.0233, -0.0284])
"""of the Livox in the frame of its clouds [m]"""


def atlas_by(workers, segments, settings, place, kill=False):
    """Makes an atlas with shuffled segments. Returns its folder, and seconds of the segments'
    maps and of all."""
    folder = Folder(place / f"{workers}-workers{'-one-killed' if kill else ''}")
    folder.prepare()
    shuffled = list(segments)
    random.Random(workers).shuffle(shuffled)
    with LocalCluster(n_workers=workers, threads_per_worker=1,
                      dashboard_address=None) as cluster, \
            Client(cluster, set_as_default=False) as client:
        pids = list(client.run(os.getpid).values())

        def tell(text):
            if kill and text.startswith("1 of"):
                os.kill(pids[0], signal.SIGKILL)

        start = time.monotonic()
        run.map_segments(client, shuffled, settings, folder, tell)
        mapped = time.monotonic() - start
        run.make_atlas(client, segments, settings, folder)
        return folder, mapped, time.monotonic() - start


def content_of(folder):
    return [(f.name, f.read_bytes())
            for f in [folder.index, *sorted((folder.path / "tiles").iterdir())]]


def poses_of(file):
    """T_map_sensor of each line, with the ray's origin as the sensor's."""
    poses = []
    for _, *t, x, y, z, w in numpy.loadtxt(file):
        rotation = numpy.array([
            [1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)],
            [2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)],
            [2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)]])
        poses.append((rotation, numpy.array(t)))
    return poses


def cloud_of(file):
    content = file.read_bytes()
    return numpy.frombuffer(content.split(b"DATA binary\n", 1)[1], "<f4").reshape(-1, 4)[:, :3]


def test_points(poses_file, scans):
    """Hits of scans that are in no map, and uniform and near free points on their rays."""
    rng = numpy.random.default_rng(1)
    hits, uniform, near = [], [], []
    for number, (rotation, position) in enumerate(poses_of(poses_file)):
        if number % SPLIT != SPLIT // 2:
            continue
        rays = cloud_of(scans / f"{number:06d}.pcd").astype(float) - RAY_ORIGIN
        rays = rays[rng.choice(len(rays), min(2000, len(rays)), replace=False)]
        length = numpy.linalg.norm(rays, axis=1)
        rays = rays[(length > 0.9)]
        length = length[length > 0.9, None]
        share = rng.uniform(size=length.shape)
        at = [length, 0.1 + share * (length - 0.25), length - 0.6 + share * 0.5]
        for points, ranges in zip((hits, uniform, near), at):
            points.append((RAY_ORIGIN + rays / length * ranges) @ rotation.T + position)
    return [numpy.concatenate(points) for points in (hits, uniform, near)]


def area_under(positive, negative):
    """Of the ROC: the share of pairs that are in the right order, ties counted half."""
    values, ranks = numpy.unique(numpy.concatenate([positive, negative]), return_inverse=True)
    counts = numpy.bincount(ranks, minlength=len(values))
    mean_rank = numpy.cumsum(counts) - (counts - 1) / 2
    n = len(positive)
    return (mean_rank[ranks[:n]].sum() - n * (n + 1) / 2) / (n * len(negative))


def areas_of(asked, points):
    hits, uniform, near = (answer.occupied + answer.unknown / 2
                           for answer in map(asked.occupancy, points))
    return area_under(hits, uniform), area_under(hits, near)


def near_borders(tiles, tile_m, hits, n=10000):
    """Points within 20 cm of borders between tiles, around hits."""
    rng = numpy.random.default_rng(2)
    points = hits[rng.choice(len(hits), n)] + rng.normal(0, 0.5, (n, 3))
    axis = rng.integers(0, 2, n)
    rows = numpy.arange(n)
    points[rows, axis] = (numpy.round(points[rows, axis] / tile_m) * tile_m
                          + rng.uniform(-0.2, 0.2, n))
    return points


def main(log, poses, scans, place):
    scans_in_log = count_scans(log)
    segments = plan.segments_of([log], [poses], [scans_in_log], -(-scans_in_log // SEGMENTS))
    assert len(segments) == SEGMENTS
    settings = plan.Settings(tile_m=25.0, margin_m=5.0, split=SPLIT)
    runs = {}
    for workers, kill in ((1, False), (2, False), (3, False), (2, True)):
        name = f"{workers} workers{', one killed' if kill else ''}"
        runs[name] = atlas_by(workers, segments, settings, place, kill)
        folder, mapped, total = runs[name]
        print(f"{name}: {total:.1f} s, of which segments {mapped:.1f} s", flush=True)
    reference = content_of(runs["1 workers"][0])
    for name, (folder, *_) in runs.items():
        assert content_of(folder) == reference, f"{name}: other bytes"
    print(f"same bytes: {len(reference) - 1} tiles, {sum(len(c) for _, c in reference)} bytes")

    start = time.monotonic()
    subprocess.run(["hgmm-replay", log, "--poses", poses, "--split", str(SPLIT), "--quiet",
                    "--threads", "1", "--save-map", place / "one.hgmm"], check=True,
                   stdout=subprocess.DEVNULL)
    print(f"one run of hgmm-replay, evaluation included: {time.monotonic() - start:.1f} s")
    one, atlas = hgmm.Map.load(place / "one.hgmm"), Atlas(runs["1 workers"][0].path, 100)
    points = test_points(poses, scans)
    areas = {"one run": areas_of(one, points), "atlas": areas_of(atlas, points)}
    for name, (uniform, near) in areas.items():
        print(f"AUC, {name}: uniform {uniform:.4f}, near {near:.4f}")

    single = Folder(place / "single-tile")
    single.prepare()
    with Client(processes=False, n_workers=1, threads_per_worker=1, dashboard_address=None,
                set_as_default=False) as client:
        run.make_atlas(client, segments, replace(settings, tile_m=1e5, margin_m=1e4), single)
    whole = Atlas(single.path)
    borders = near_borders(atlas.tiles, settings.tile_m, points[0])
    here, there = atlas.occupancy(borders), whole.occupancy(borders)
    difference = numpy.max([abs(a - b) for a, b in zip(here[:3], there[:3])], axis=0)
    print(f"near borders of tiles: largest difference {difference.max():.2g}, beyond .001 at "
          f"{(difference > 1e-3).sum()} of {len(borders)} points")
    assert abs(areas["one run"][0] - areas["atlas"][0]) <= 0.001
    assert abs(areas["one run"][1] - areas["atlas"][1]) <= 0.005


if __name__ == "__main__":
    if len(sys.argv) not in (4, 5):
        sys.exit(__doc__)
    given = [os.path.abspath(word) for word in sys.argv[1:]]
    with tempfile.TemporaryDirectory() as temporary:
        main(given[0], given[1], pathlib.Path(given[2]),
             pathlib.Path(given[3] if len(given) > 3 else temporary))
