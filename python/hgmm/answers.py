"""What the functions of hgmm.Map return: named tuples of arrays and numbers."""
from typing import NamedTuple

import numpy


class InsertReport(NamedTuple):
    """What one scan did to the map, in counts."""

    points_used: int
    """points that became samples"""
    points_not_finite: int
    """points dropped, for they hold NaN or infinity"""
    points_too_near: int
    """points dropped, nearer than the option minRange_m"""
    points_cut: int
    """points beyond maxRange_m: no surface, but their rays clear space"""
    samples: int
    """leaves of the filter that hold points"""
    samples_novel: int
    """samples that the map did not explain before this scan"""
    components_updated: int
    """components that absorbed known samples"""
    components_added: int
    """components for novel samples"""
    components_missed: int
    """components of few hits, that a ray was for and missed"""
    components_carved: int
    """components that the scan saw through"""
    components_oversized: int
    """components too thick for what the scan saw there"""
    components_removed: int
    """components of the last three kinds that went for want of support"""


class Occupancy(NamedTuple):
    """Arrays of shape (N,), float32: columns of one array of shape (N, 5).

    The three probabilities sum to one.
    """

    occupied: numpy.ndarray
    """P(occ = 1 | x), thesis eq. (4.15), in [0, 1]"""
    free: numpy.ndarray
    """P(occ = 0 | x), thesis eq. (4.16), in [0, 1]"""
    unknown: numpy.ndarray
    """never seen, or behind a surface, in [0, 1]"""
    along_ray: numpy.ndarray
    """E[W | x] [m], along the rays that saw x, thesis eq. (4.17); 0 where it is not known"""
    variance: numpy.ndarray
    """Var[W | x] [m^2], thesis eq. (4.18); 0 where it is not known"""


class Distance(NamedTuple):
    """Arrays of shape (N,), float32, NaN where no component reaches the point."""

    mean: numpy.ndarray
    """E[W | x] [m], along the rays that saw x, thesis eq. (4.17)"""
    variance: numpy.ndarray
    """Var[W | x] [m^2], thesis eq. (4.18), > 0"""


class SurfaceDistance(NamedTuple):
    """Arrays of shape (N,), columns of one buffer."""

    distance: numpy.ndarray
    """to the nearest surface [m], float64, >= 0; max_distance where none is nearer"""
    gradient: numpy.ndarray
    """of that distance, shape (N, 3), float64: the unit vector away from the surface; zero on
    it and where there is none"""
    std: numpy.ndarray
    """standard deviation of the distance [m], float64; 0 where there is no surface"""
    known: numpy.ndarray
    """whether there is a surface, and as many hits behind it as make one, bool"""


class Modality(NamedTuple):
    """Arrays of shape (N,)."""

    mean: numpy.ndarray
    """m(x), thesis eq. (5.6) [unit of the channel], float64"""
    variance: numpy.ndarray
    """v(x), thesis eq. (5.7) [unit squared], >= 0, float64"""
    known: numpy.ndarray
    """whether anything was measured around x, bool; if not, mean and variance are those of
    all that was measured anywhere"""


class Inferred(NamedTuple):
    """A modality inferred from others, thesis 5.2."""

    mean: float
    """thesis eq. (5.13) [unit of the channel]"""
    variance: float
    """eq. (5.7) at the place [unit squared], >= 0"""
    known: bool
    """whether a place with such values was found; if not, mean and variance are the target's
    own regression at the point that was asked for"""
    place: numpy.ndarray
    """x_p of thesis eq. (5.12), (5.14), shape (3,), in the map frame [m]"""
    likelihood: float
    """of the values there, thesis eq. (5.14) [sum of 1/unit]"""


class RayHit(NamedTuple):
    """Where a ray meets the first surface."""

    range: float
    """from the ray's origin [m]"""
    point: numpy.ndarray
    """shape (3,), in the map frame [m]"""


class Registration(NamedTuple):
    """How another map lies in this one."""

    pose: numpy.ndarray
    """T_this_other, shape (4, 4) [m]"""
    covariance: numpy.ndarray
    """of the pose's error (w, v), shape (6, 6): rotation [rad] before translation [m], both in
    the axes of this map: truth = (exp(w) R, t + v)"""
    converged: bool
    """whether at least the asked overlap was found"""
    iterations: int
    """of all stages and candidates"""
    overlap: float
    """share of the other map's components near one of this map, in [0, 1]"""
    cost: float
    """of the last stage, <= 0"""


class Mixture(NamedTuple):
    """Gaussians of one level, in the map frame."""

    mean: numpy.ndarray
    """shape (N, D), float64 [m]"""
    covariance: numpy.ndarray
    """shape (N, D, D), float64 [m^2]"""
    support: numpy.ndarray
    """measurements explained, shape (N,), float64 [count], > 0"""
