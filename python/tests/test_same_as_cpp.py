"""Answers and maps are those of the C++ core, bit for bit."""
import numpy
import pytest

import hgmm
from conftest import HALF_SIZES, pose_at, scan_room


def write(folder, room, points):
    (folder / "map").write_bytes(room.to_bytes(exact=True))
    points.tofile(folder / "points")
    return folder / "map", folder / "points", folder / "answers"


def test_map_of_a_scan(tmp_path, oracle):
    points = scan_room(pose_at(0, 0, 0))
    points[3] = numpy.nan
    points.tofile(tmp_path / "points")
    oracle("insert", tmp_path / "points", tmp_path / "map")
    here = hgmm.Map()
    here.insert(points)
    assert here.to_bytes(exact=True) == (tmp_path / "map").read_bytes()


def test_occupancy(tmp_path, oracle, room, places):
    files = write(tmp_path, room, places)
    oracle("occupancy", *files)
    expected = numpy.fromfile(files[-1], numpy.float32).reshape(-1, 5)
    here = numpy.stack(room.occupancy(places), axis=1)
    assert here.tobytes() == expected.tobytes()
    assert 0.2 < (here[:, 1] > 0.5).mean() < 0.9  # free and other places are among them


def test_along_ray_is_that_of_occupancy_where_it_is_known(room, places):
    along_ray, occupancy = room.along_ray(places), room.occupancy(places)
    known = (occupancy.unknown < 1) & (occupancy.variance > 0)
    assert 0.2 < known.mean() < 1
    assert numpy.array_equal(along_ray.mean[known], occupancy.along_ray[known])
    assert numpy.array_equal(along_ray.variance[known], occupancy.variance[known])
    assert numpy.isnan(along_ray.mean[~known]).all() and numpy.isnan(along_ray.variance[~known]).all()


@pytest.mark.parametrize("max_distance, level", [(5.0, 0), (0.4, 0), (1.5, 2)])
def test_distance(tmp_path, oracle, room, places, max_distance, level):
    files = write(tmp_path, room, places)
    oracle("distance", *files, max_distance, level)
    expected = numpy.fromfile(files[-1], numpy.float64).reshape(-1, 6)
    here = room.distance(places, max_distance=max_distance, level=level)
    assert here.gradient.shape == (len(places), 3) and here.known.dtype == bool
    assert numpy.column_stack(here).tobytes() == expected.tobytes()
    assert 0.2 < here.known.mean() <= 1
    far = here.std == 0
    assert (here.distance[far] == max_distance).all() and not here.gradient[far].any()
    assert numpy.allclose(numpy.linalg.norm(here.gradient[~far], axis=1), 1)


def test_distance_to_the_walls(room):
    points = numpy.array([[3.2, 2, 0], [3, 0, 0.2], [0, -2.5, 0], [-3.8, 1, -0.3]])
    here = room.distance(points)
    assert numpy.abs(here.distance - (HALF_SIZES - abs(points)).min(axis=1)).max() < 0.02
    axis = (HALF_SIZES - abs(points)).argmin(axis=1)
    assert (numpy.abs(here.gradient[numpy.arange(4), axis]) > 0.99).all()
    with pytest.raises(ValueError):
        room.distance(points, max_distance=0)
    with pytest.raises(IndexError):
        room.distance(points, level=99)


def test_modality(tmp_path, oracle, room, places):
    files = write(tmp_path, room, places)
    oracle("modality", *files, "warm")
    expected = numpy.fromfile(files[-1], numpy.float64).reshape(-1, 3)
    here = numpy.stack(room.modality("warm", places), axis=1)
    assert here.tobytes() == expected.tobytes()
    assert 0.1 < expected[:, 2].mean() < 1


def test_any_number_of_points_and_single_ones_agree(room, places):
    whole = room.occupancy(places)
    for i in (0, 7, 400):
        single = room.occupancy(places[i:i + 1])
        assert [x.tolist() for x in single] == [x[i:i + 1].tolist() for x in whole]
