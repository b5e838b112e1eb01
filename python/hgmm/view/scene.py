"""What the page shows of a map, as arrays."""
from typing import NamedTuple, Optional

import numpy

from hgmm.view.inputs import Poses
from hgmm.view.slices import Lattice, lattice_of

MOST_COMPONENTS = 250_000
MOST_POINTS = 100_000
MOST_POSES = 4000


class Ellipsoids(NamedTuple):
    """Components of all levels, one level after the other."""

    mean: numpy.ndarray
    """relative to the scene's centre, shape (N, 3), float32 [m]"""
    deviation: numpy.ndarray
    """along the ellipsoid's axes, the longest first, shape (N, 3), float32 [m]"""
    turn: numpy.ndarray
    """of those axes: unit quaternions x y z w times 32767, shape (N, 4), int16"""
    support: numpy.ndarray
    """measurements explained, shape (N,), float32"""
    first: list
    """for each level the number of its first component, and at the end N"""


class Scene(NamedTuple):
    """All that the page shows."""

    centre: numpy.ndarray
    """of the box, in the map frame, shape (3,) [m]; other places are relative to it"""
    low: numpy.ndarray
    high: numpy.ndarray
    """corners of a box around all surfaces but a few strays, shape (3,) [m]"""
    finest: int
    """the level of the map that is level 0 of the page"""
    surfaces: Ellipsoids
    occupied: numpy.ndarray
    """P(occupied) at the surfaces' means, shape (N,), float32"""
    along_ray_deviation: numpy.ndarray
    """standard deviation of the distance there along the rays, shape (N,), float32 [m]"""
    modalities: dict
    """name -> mean and standard deviation there, shape (N, 2), float32"""
    free: Ellipsoids
    lattice: Lattice
    """its low corner is relative to the centre"""
    points: Optional[numpy.ndarray]
    """shape (N, 3), float32 [m]"""
    poses: Optional[Poses]


def quaternions_of(rotations):
    """Unit quaternions x y z w of rotation matrices, shape (N, 3, 3) -> (N, 4).

    The largest of the four is found from the diagonal, and the others from products with it.
    """
    r = rotations
    trace = numpy.trace(r, axis1=1, axis2=2)
    squares = numpy.stack([1 + 2 * r[:, 0, 0] - trace, 1 + 2 * r[:, 1, 1] - trace,
                           1 + 2 * r[:, 2, 2] - trace, 1 + trace], axis=1) / 4
    xy, xz, yz = (r[:, a, b] + r[:, b, a] for a, b in ((0, 1), (0, 2), (1, 2)))
    xw, yw, zw = (r[:, b, a] - r[:, a, b] for a, b in ((1, 2), (2, 0), (0, 1)))
    products = numpy.stack([4 * squares[:, 0], xy, xz, xw, xy, 4 * squares[:, 1], yz, yw,
                            xz, yz, 4 * squares[:, 2], zw, xw, yw, zw, 4 * squares[:, 3]],
                           axis=1).reshape(-1, 4, 4)
    chosen = products[numpy.arange(len(r)), squares.argmax(axis=1)]
    return chosen / numpy.linalg.norm(chosen, axis=1, keepdims=True)


def ellipsoids_of(mixtures, centre):
    """The ellipsoids of mixtures, the first three of their dimensions."""
    mean = numpy.concatenate([m.mean[:, :3] for m in mixtures]) - centre
    covariance = numpy.concatenate([m.covariance[:, :3, :3] for m in mixtures])
    squares, axes = numpy.linalg.eigh(covariance)
    axes = axes[:, :, ::-1]
    axes[:, :, 2] *= numpy.sign(numpy.linalg.det(axes))[:, None]
    first = numpy.concatenate([[0], numpy.cumsum([len(m.support) for m in mixtures])])
    return Ellipsoids(
        mean.astype(numpy.float32),
        numpy.sqrt(numpy.maximum(squares[:, ::-1], 1e-12)).astype(numpy.float32),
        numpy.rint(32767 * quaternions_of(axes)).astype(numpy.int16),
        numpy.concatenate([m.support for m in mixtures]).astype(numpy.float32),
        [int(n) for n in first])


def finest_shown(levels):
    """The finest level from which on all levels together are not too many."""
    for finest in range(len(levels)):
        if sum(level["surface"] + level["free"] for level in levels[finest:]) <= MOST_COMPONENTS:
            return finest
    return len(levels) - 1


def evenly(count, most):
    """Indices of at most so many of `count`, evenly apart, the last among them."""
    return numpy.unique(numpy.linspace(0, count - 1, min(count, most)).astype(int))


def answers_at(map_, mixtures, finest, names):
    """What each level says at its own means.

    names: of the modalities.
    """
    asked = [map_.occupancy(m.mean, level) for level, m in enumerate(mixtures, finest)]
    occupied = numpy.concatenate([a.occupied for a in asked])
    deviation = numpy.sqrt(numpy.concatenate([a.variance for a in asked]))
    means = numpy.concatenate([m.mean for m in mixtures])
    modalities = {}
    for name in names:
        found = map_.modality(name, means)
        modalities[name] = numpy.stack([numpy.where(found.known, found.mean, numpy.nan),
                                        numpy.sqrt(found.variance)], axis=1)
    return occupied, deviation, {k: v.astype(numpy.float32) for k, v in modalities.items()}


def scene_of(map_, poses=None, points=None, say=lambda text: None):
    """What the page shows of a map.

    poses: Poses, or None. points: shape (N, 3) [m], in the map frame, or None.
    say: is told in one sentence what the page leaves out.

    Raises ValueError for a map without surfaces.
    """
    if map_.empty:
        raise ValueError("the map has no surfaces to show")
    info = map_.info()
    levels = info["levels"]
    finest = finest_shown(levels)
    if finest > 0:
        say(f"levels below {finest} are left out: with them there are more than "
            f"{MOST_COMPONENTS} components")
    mixtures = [map_.mixture(level) for level in range(finest, len(levels))]
    free = [map_.free_mixture(level) for level in range(finest, len(levels))]
    lattice = lattice_of(map_, map_.mixture())
    low = lattice.low
    high = low + lattice.cell * lattice.answers.shape[2::-1]
    centre = (low + high) / 2
    occupied, deviation, modalities = answers_at(map_, mixtures, finest, info["modalities"])
    if points is not None:
        points = (points[evenly(len(points), MOST_POINTS)] - centre).astype(numpy.float32)
    if poses is not None:
        kept = evenly(len(poses.time), MOST_POSES)
        poses = Poses(poses.time[kept], poses.position[kept] - centre, poses.turn[kept])
    return Scene(centre, low, high, finest, ellipsoids_of(mixtures, centre), occupied, deviation,
                 modalities, ellipsoids_of(free, centre), lattice._replace(low=low - centre),
                 points, poses)
