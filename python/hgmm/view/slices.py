"""Occupied, free and unknown on a lattice, to cut slices out of."""
from typing import NamedTuple

import numpy

MOST_CELLS = 1_000_000
SMALLEST_CELL = 0.02
"""in the plane [m]"""
STEPS = 50
"""of a probability, as stored"""
STRAY_SHARE = 0.02
"""of the points, on either side of an axis, that need not be in the box"""
SURFACE_POINTS = 250_000
"""to look for occupied places between the centres of cells"""


class Lattice(NamedTuple):
    """What the map says in cells: at their centres, and at surfaces that pass them elsewhere."""

    low: numpy.ndarray
    """the lowest corner of the box, in the map frame, shape (3,) [m]"""
    cell: numpy.ndarray
    """edges of a cell, shape (3,) [m]"""
    answers: numpy.ndarray
    """P(occupied) and P(free) in steps of 1/50, shape (z, y, x, 2), uint8"""


def weighted_quantile(values, weights, share):
    """The value that a share of the weight lies below."""
    order = numpy.argsort(values, kind="stable")
    below = numpy.cumsum(weights[order])
    return values[order][min(len(values) - 1, numpy.searchsorted(below, share * below[-1]))]


def box_of(mean, reach, support):
    """The lowest and highest corner of a box around what all but a few points explain.

    mean, reach: of components, their centres and standard deviations along the axes, shape
        (N, 3) [m]. support: points explained, shape (N,).
    """
    low, high = (numpy.array([weighted_quantile((mean + side * reach)[:, k], support, share)
                              for k in range(3)])
                 for side, share in ((-1, STRAY_SHARE), (1, 1 - STRAY_SHARE)))
    margin = 0.1 * (high - low)
    return (numpy.maximum(low - margin, (mean - 2 * reach).min(axis=0)),
            numpy.minimum(high + margin, (mean + 2 * reach).max(axis=0)))


def cells_of(size):
    """Edges of cells that fill a box [m]: twice as high as wide, as slices are looked at from
    above most."""
    edge = max(SMALLEST_CELL, numpy.cbrt(numpy.prod(size) / 2 / MOST_CELLS))
    # A flat box has one layer of cells, which may be smaller.
    if size[2] < 2 * edge:
        edge = max(SMALLEST_CELL, numpy.sqrt(size[0] * size[1] / MOST_CELLS))
    counts = numpy.maximum(1, numpy.ceil(size / (edge * numpy.array([1, 1, 2])))).astype(int)
    return size / counts, counts


def surface_points(mean, covariance):
    """Points on components, as many on each: over their two longest axes, to 1.5 sigma."""
    side = int(numpy.clip(numpy.sqrt(SURFACE_POINTS / len(mean)), 3, 15))
    squares, axes = numpy.linalg.eigh(covariance)
    u, v = numpy.meshgrid(*2 * [numpy.linspace(-1.5, 1.5, side)])
    spread = axes[:, :, :0:-1] * numpy.sqrt(numpy.maximum(squares[:, None, :0:-1], 0))
    offsets = numpy.einsum("nka,am->nmk", spread, numpy.stack([u.ravel(), v.ravel()]))
    return (mean[:, None, :] + offsets).reshape(-1, 3)


def add_surfaces(map_, mixture, lattice):
    """Gives cells the answer of the most occupied point of a surface in them."""
    places = surface_points(mixture.mean, mixture.covariance)
    index = numpy.floor((places - lattice.low) / lattice.cell).astype(int)
    counts = numpy.array(lattice.answers.shape[2::-1])
    inside = ((index >= 0) & (index < counts)).all(axis=1)
    places, index = places[inside], index[inside]
    found = map_.occupancy(places)
    # Written in this order, the most occupied is what stays.
    order = numpy.argsort(found.occupied, kind="stable")
    order = order[found.occupied[order] > 0.5]
    x, y, z = index[order].T
    occupied = numpy.rint(found.occupied[order] * STEPS)
    free = numpy.minimum(numpy.rint(found.free[order] * STEPS), STEPS - occupied)
    lattice.answers[z, y, x] = numpy.stack([occupied, free], axis=1)


def lattice_of(map_, mixture):
    """What the map says in the box around the surfaces of its finest level."""
    reach = numpy.sqrt(numpy.diagonal(mixture.covariance, axis1=1, axis2=2))
    low, high = box_of(mixture.mean, reach, mixture.support)
    cell, counts = cells_of(high - low)
    x, y, z = (low[k] + cell[k] * (numpy.arange(counts[k]) + 0.5) for k in range(3))
    answers = numpy.empty((counts[2], counts[1], counts[0], 2), numpy.uint8)
    plane = numpy.stack([*numpy.meshgrid(x, y), numpy.empty((len(y), len(x)))], axis=-1)
    for layer, height in enumerate(z):
        plane[..., 2] = height
        found = map_.occupancy(plane.reshape(-1, 3))
        for k, share in enumerate((found.occupied, found.free)):
            answers[layer, ..., k] = numpy.rint(share * STEPS).reshape(len(y), len(x))
    lattice = Lattice(low, cell, answers)
    add_surfaces(map_, mixture, lattice)
    return lattice
