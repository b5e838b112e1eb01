"""Answers and maps are those of the C++ core, bit for bit."""
import numpy

import hgmm
from conftest import pose_at, scan_room


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
