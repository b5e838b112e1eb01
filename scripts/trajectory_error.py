#!/usr/bin/env python3
"""Compares two trajectories, TUM lines with the same stamps, after the rigid motion that
lays one on the other best: absolute trajectory error.

    scripts/trajectory_error.py ESTIMATE.tum REFERENCE.tum

Prints the number of poses that both have, root mean square and largest error of the
position [m], median and largest error of the rotation [deg], length of the way [m].
"""

import sys

import numpy as np


def rotation(q):
    x, y, z, w = q / np.linalg.norm(q)
    return np.array(
        [
            [1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)],
            [2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)],
            [2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)],
        ]
    )


def pairs(estimate, reference, tolerance_s=0.01):
    """Indices of poses whose stamps are nearest to each other."""
    at = np.searchsorted(reference[:, 0], estimate[:, 0])
    before = np.clip(at - 1, 0, len(reference) - 1)
    after = np.clip(at, 0, len(reference) - 1)
    apart = lambda i: np.abs(reference[i, 0] - estimate[:, 0])
    nearest = np.where(apart(before) <= apart(after), before, after)
    kept = apart(nearest) <= tolerance_s
    return np.flatnonzero(kept), nearest[kept]


def alignment(points, targets):
    """R, t that take points to targets (Umeyama 1991, without scale)."""
    p, q = points.mean(0), targets.mean(0)
    u, _, v = np.linalg.svd((targets - q).T @ (points - p))
    sign = np.diag([1.0, 1.0, np.sign(np.linalg.det(u @ v))])
    r = u @ sign @ v
    return r, q - r @ p


def main():
    if len(sys.argv) != 3:
        sys.exit(__doc__)
    estimate, reference = (np.atleast_2d(np.loadtxt(f)) for f in sys.argv[1:])
    i, j = pairs(estimate, reference)
    if len(i) < 3:
        sys.exit("trajectory_error.py: fewer than three stamps in common")
    estimate, reference = estimate[i], reference[j]
    r, t = alignment(estimate[:, 1:4], reference[:, 1:4])
    off_m = np.linalg.norm(estimate[:, 1:4] @ r.T + t - reference[:, 1:4], axis=1)
    turns = [
        rotation(b[4:8]).T @ r @ rotation(a[4:8]) for a, b in zip(estimate, reference)
    ]
    # The mean rotation between the two frames, for sensors that are mounted otherwise.
    u, _, v = np.linalg.svd(sum(turns))
    mount = u @ np.diag([1, 1, np.linalg.det(u @ v)]) @ v
    off_deg = [
        np.degrees(np.arccos(np.clip((np.trace(mount.T @ m) - 1) / 2, -1, 1))) for m in turns
    ]
    way_m = np.linalg.norm(np.diff(reference[:, 1:4], axis=0), axis=1).sum()
    print(
        f"{len(i)} {np.sqrt((off_m**2).mean()):.3f} {off_m.max():.3f} "
        f"{np.median(off_deg):.2f} {max(off_deg):.2f} {way_m:.1f}"
    )


if __name__ == "__main__":
    main()
