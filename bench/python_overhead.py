#!/usr/bin/env python3
"""What Python adds to a batch of queries, beside the same batch in C++.

    PYTHONPATH=build/python /usr/bin/python3 bench/python_overhead.py build/tests/python-oracle

A path to a .hgmm file may follow. Without it, the map is one of a simulated room. Times are CPU times of all threads, which other programs
disturb little. Rounds alternate, best of each counts.
"""
import os
import pathlib
import subprocess
import sys
import tempfile
import time

import numpy

os.environ.setdefault("OMP_WAIT_POLICY", "passive")  # threads that wait take no CPU time
import hgmm  # noqa: E402

BATCH = 10_000
ROUNDS = 10


def room():
    """A map of the walls of a box, as four scans see them."""
    rays = numpy.random.default_rng(2).standard_normal((30_000, 3))
    rays /= numpy.linalg.norm(rays, axis=1)[:, None]
    result = hgmm.Map()
    for x in (-2, -1, 1, 2):
        pose = numpy.eye(4)
        pose[0, 3] = x
        to_walls = (numpy.sign(rays) * [4, 3, 1.5] - pose[:3, 3]) / rays
        result.insert(rays * to_walls.min(axis=1)[:, None], pose)
    return result


def seconds_of(call, repetitions=20):
    best = float("inf")
    for _ in range(repetitions):
        start = time.process_time()
        call()
        best = min(best, time.process_time() - start)
    return best


def main():
    oracle = sys.argv[1]
    queried = hgmm.Map.load(sys.argv[2]) if len(sys.argv) > 2 else room()
    mean = queried.mixture().mean
    low, high = mean.min(axis=0), mean.max(axis=0)
    points = numpy.random.default_rng(1).uniform(low, high, (BATCH, 3))
    with tempfile.TemporaryDirectory() as folder:
        files = [pathlib.Path(folder, name) for name in ("map", "points")]
        files[0].write_bytes(queried.to_bytes(exact=True))
        points.tofile(files[1])
        in_cpp, in_python = [], []
        for _ in range(ROUNDS):
            told = subprocess.run([oracle, "time", *files], check=True, stdout=subprocess.PIPE)
            in_cpp.append(float(told.stdout))
            in_python.append(seconds_of(lambda: queried.occupancy(points)))
    calls = 10_000
    empty = seconds_of(lambda: [queried.occupancy(points[:0]) for _ in range(calls)], 3) / calls
    print(f"{queried!r}, {BATCH} points a batch")
    print(f"C++     {1e3 * min(in_cpp):8.3f} ms")
    more = min(in_python) / min(in_cpp) - 1
    print(f"Python  {1e3 * min(in_python):8.3f} ms, {100 * more:+.1f} %")
    print(f"a call without points {1e6 * empty:.1f} us")


if __name__ == "__main__":
    main()
