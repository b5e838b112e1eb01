"""A simulated room, and the C++ programs that the package is compared with."""
import os
import pathlib
import subprocess

import numpy
import pytest

import hgmm

HALF_SIZES = numpy.array([4.0, 3.0, 1.5])
"""of the room, whose middle is the origin of the map [m]"""


def pose_at(x, y, z, yaw=0.0):
    """T_map_sensor, upright."""
    pose = numpy.eye(4)
    pose[:2, :2] = [[numpy.cos(yaw), -numpy.sin(yaw)], [numpy.sin(yaw), numpy.cos(yaw)]]
    pose[:3, 3] = [x, y, z]
    return pose


def scan_room(pose, rings=24, rays=240, noise=0.003, seed=1):
    """Points of a lidar in the room, in the sensor frame [m]."""
    elevation, azimuth = numpy.meshgrid(numpy.linspace(-0.5, 0.5, rings),
                                        numpy.arange(rays) * 2 * numpy.pi / rays, indexing="ij")
    rays_sensor = numpy.stack([numpy.cos(elevation) * numpy.cos(azimuth),
                               numpy.cos(elevation) * numpy.sin(azimuth),
                               numpy.sin(elevation)], axis=-1).reshape(-1, 3)
    rays_map = rays_sensor @ pose[:3, :3].T
    with numpy.errstate(divide="ignore", invalid="ignore"):
        to_walls = (numpy.sign(rays_map) * HALF_SIZES - pose[:3, 3]) / rays_map
    ranges = numpy.where(rays_map == 0, numpy.inf, to_walls).min(axis=1)
    ranges += noise * numpy.random.default_rng(seed).standard_normal(len(ranges))
    return rays_sensor * ranges[:, None]


def warmth_of(points_map):
    """A quantity that varies over the room, in [0, 1], and its opposite."""
    warmth = 0.5 + 0.1 * points_map[:, 0]
    return {"warm": warmth, "cold": 1 - warmth}


def map_of_room(pose_of_frame=numpy.eye(4), seed=1, **options):
    """A map of three scans, in a frame whose pose in the room is given."""
    room = hgmm.Map(**options)
    into_frame = numpy.linalg.inv(pose_of_frame)
    for i, pose in enumerate([pose_at(0, 0, 0), pose_at(1, 0.5, 0.2, 0.7),
                              pose_at(-1.5, -1, 0, 2)]):
        points = scan_room(pose, seed=seed + i)
        channels = warmth_of(points @ pose[:3, :3].T + pose[:3, 3])
        room.insert(points, into_frame @ pose, channels if "modalities" in options else {})
    return room


@pytest.fixture(scope="session", autouse=True)
def coarse_slices():
    """Slices of pages are coarser than users have them, and quicker."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr("hgmm.view.slices.MOST_CELLS", 80_000)
        patch.setattr("hgmm.view.slices.SURFACE_POINTS", 60_000)
        yield


@pytest.fixture(scope="session")
def room():
    return map_of_room(modalities=["warm", "cold"])


@pytest.fixture(scope="session")
def places():
    """Points in the room, in its walls and beyond, and one that is none."""
    points = numpy.random.default_rng(5).uniform(-1.2, 1.2, (2000, 3)) * HALF_SIZES
    points[7] = numpy.nan
    return points


@pytest.fixture(scope="session")
def oracle():
    """Runs the C++ program that answers as the core does."""
    def run(*words):
        return subprocess.run([os.environ["HGMM_ORACLE"], *map(str, words)], check=True,
                              stdout=subprocess.PIPE, text=True).stdout
    return run


@pytest.fixture(scope="session")
def golden():
    """Folder of maps that releases saved, with the answers that they must give."""
    return pathlib.Path(os.environ["HGMM_SOURCE_DIR"], "tests/mrpt-hgmm/data")


@pytest.fixture(scope="session")
def map_tool():
    """Runs hgmm-map, where the build has MRPT."""
    if "HGMM_MAP_TOOL" not in os.environ:
        pytest.skip("hgmm-map is not built")

    def run(*words):
        return subprocess.run([os.environ["HGMM_MAP_TOOL"], *map(str, words)], check=True,
                              stdout=subprocess.PIPE, text=True).stdout
    return run
