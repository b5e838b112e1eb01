"""A 3D occupancy map made of Gaussians.

>>> import hgmm, numpy
>>> grid = numpy.mgrid[-1:1:0.02, -1:1:0.02].reshape(2, -1)
>>> wall = numpy.stack([numpy.full(grid.shape[1], 2.0), *grid], axis=1)
>>> scan_map = hgmm.Map(resolution_m=0.04)
>>> scan_map.insert(wall).points_used
10000
>>> scan_map.occupancy([[1.0, 0.0, 0.0]]).free > 0.5
array([ True])

Lengths are in metres, angles in radians. Points are arrays of shape (N, 3). A pose is a
matrix of shape (4, 4) that takes points of one frame to another: T_map_sensor those of the
sensor to the map. Maps can be used from several threads.
"""
from hgmm._core import FormatError, Map, __version__
from hgmm.answers import (Distance, Inferred, InsertReport, Mixture, Modality, Occupancy,
                          RayHit, Registration, SurfaceDistance)

__all__ = ["Distance", "FormatError", "Inferred", "InsertReport", "Map", "Mixture", "Modality",
           "Occupancy", "RayHit", "Registration", "SurfaceDistance", "__version__"]
