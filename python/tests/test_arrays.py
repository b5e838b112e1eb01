"""Shapes and dtypes in and out, and what is refused."""
import numpy
import pytest

import hgmm
from conftest import HALF_SIZES, map_of_room, pose_at, scan_room


def same(a, b):
    return all(x.tobytes() == y.tobytes() for x, y in zip(a, b))


def test_shapes_and_dtypes_of_answers(room, places):
    for array in (*room.occupancy(places), *room.along_ray(places)):
        assert array.shape == (len(places),) and array.dtype == numpy.float32
    mean, variance, known = room.modality("warm", places)
    assert mean.dtype == variance.dtype == numpy.float64 and known.dtype == bool
    n = room.info()["levels"][1]["surface"]
    mean, covariance, support = room.mixture(1)
    assert mean.shape == (n, 3) and covariance.shape == (n, 3, 3) and support.shape == (n,)
    n = room.info()["levels"][0]["free"]
    assert [a.shape for a in room.free_mixture()] == [(n, 4), (n, 4, 4), (n,)]
    assert room.sample(5).shape == (5, 3)


@pytest.mark.parametrize("convert", [
    lambda p: p.astype(numpy.float64, order="F"),
    lambda p: p.astype(">f8"),
    lambda p: numpy.repeat(p, 2, axis=0)[::2],
    lambda p: p.tolist(),
    lambda p: numpy.frombuffer(b"x" + p.tobytes(), numpy.float64, offset=1).reshape(p.shape),
])
def test_layout_does_not_matter(room, places, convert):
    assert same(room.occupancy(convert(places)), room.occupancy(places))


def test_other_dtypes_are_converted(room):
    whole = numpy.array([[0, 0, 0], [3, 1, -1]])
    for dtype in (numpy.int32, numpy.uint8, numpy.float32, numpy.float16):
        points = whole.clip(0).astype(dtype)
        assert same(room.occupancy(points), room.occupancy(points.astype(float)))


def test_float32_points_give_the_same_map_as_float64():
    points = scan_room(pose_at(0, 0, 0))
    maps = [hgmm.Map(), hgmm.Map(), hgmm.Map()]
    for it, scan in zip(maps, (points, points.astype(numpy.float32),
                               points.astype(numpy.float32, order="F"))):
        it.insert(scan)
    assert maps[0] == maps[1] == maps[2]


def test_answers_outlive_the_map(places):
    room = map_of_room()
    occupied = room.occupancy(places).occupied
    before = occupied.copy()
    del room
    for _ in range(20):
        numpy.ones(len(places) * 5, numpy.float32)
    assert occupied.tobytes() == before.tobytes()


def test_no_points(room):
    for none in (numpy.zeros((0, 3)), []):
        assert all(a.shape == (0,) for a in room.occupancy(none))
        assert all(a.shape == (0,) for a in room.modality("warm", none))
        assert hgmm.Map().insert(none).points_used == 0


def test_mixture_is_in_the_map_frame():
    far = pose_at(-1000.25, 2000.5, 10)
    room = map_of_room(far)
    middle_map = -far[:3, 3]
    mean, covariance, support = room.mixture()
    assert numpy.abs(mean - middle_map).max(axis=0) == pytest.approx(HALF_SIZES, abs=0.1)
    assert (numpy.linalg.eigvalsh(covariance) > 0).all() and (support > 0).all()
    assert numpy.array_equal(covariance, covariance.swapaxes(1, 2))
    assert support.sum() == pytest.approx(room.info()["points"])
    assert (room.occupancy(mean).occupied > 0.5).mean() > 0.9
    assert numpy.abs(room.free_mixture().mean[:, :3] - middle_map).max() < 5


POINTS = numpy.zeros((4, 3))


@pytest.mark.parametrize("call, words", [
    (lambda m: m.insert(numpy.zeros((4, 2))),
     r"points_sensor: expected shape \(N, 3\), got \(4, 2\)"),
    (lambda m: m.insert(numpy.zeros(3)), r"points_sensor: .* got \(3,\)"),
    (lambda m: m.insert(POINTS, numpy.eye(3)), r"T_map_sensor: .*\(4, 4\), got \(3, 3\)"),
    (lambda m: m.insert(POINTS, numpy.full((4, 4), numpy.nan)),
     r"T_map_sensor: .*\(4, 4\).*not finite"),
    (lambda m: m.insert(POINTS, numpy.diag([1, 1, -1, 1])), "T_map_sensor: .* not orthonormal"),
    (lambda m: m.insert(POINTS, numpy.diag([1, 1, 1, 2])), "T_map_sensor: .* last row"),
    (lambda m: m.insert(POINTS, channels={"r": numpy.zeros(3)}),
     r"channels\['r'\]: .*\(4,\), got \(3,\)"),
    (lambda m: m.insert(POINTS, cleared_rays_sensor=[[1, 0]]),
     r"cleared_rays_sensor: .* got \(1, 2\)"),
    (lambda m: m.insert(POINTS, cleared_rays_sensor=[[1, 0, numpy.inf]]), "ray 0 is not finite"),
    (lambda m: m.occupancy(numpy.zeros((2, 4))), r"points_map: .* got \(2, 4\)"),
    (lambda m: m.modality("heat", POINTS), "heat"),
    (lambda m: m.modality("warm", numpy.zeros(4)), r"points_map: .* got \(4,\)"),
    (lambda m: m.infer("cold", {}), ""),
    (lambda m: m.infer("cold", {"warm": numpy.nan}), ""),
    (lambda m: m.infer("cold", {"warm": 1.0}, [0, 0]), r"point_map: .*\(3,\), got \(2,\)"),
    (lambda m: m.cast_ray([0, 0, 0], [0, 0, 0]), "direction"),
    (lambda m: m.cast_ray([0, 0], [0, 0, 1]), r"origin_map: .*\(3,\), got \(2,\)"),
    (lambda m: m.cast_ray([0, 0, 0], [0, 0, 1], max_range=-1), ""),
    (lambda m: m.merge(m, numpy.full((4, 4), numpy.inf)), "T_this_other: .* not finite"),
    (lambda m: m.register(hgmm.Map()), "empty map"),
    (lambda m: m.register(m, min_overlap=2), "minOverlap"),
    (lambda m: m.forget([1, 1, 1], [0, 0, 0]), "box"),
])
def test_bad_input_is_named_and_changes_nothing(call, words):
    room = map_of_room(modalities=["warm", "cold"])
    before = room.copy()
    with pytest.raises(ValueError, match=words):
        call(room)
    assert room == before


@pytest.mark.parametrize("points", ["text", [["a", "b", "c"]], [[1j, 0, 0]], [[None] * 3],
                                    [[True] * 3]])
def test_what_is_no_number_is_refused(room, points):
    with pytest.raises((TypeError, ValueError), match="points_map: expected"):
        room.occupancy(points)


def test_levels_that_do_not_exist(room):
    for ask in (room.mixture, room.free_mixture, lambda level: room.occupancy(POINTS, level),
                lambda level: room.sample(1, level=level)):
        with pytest.raises(IndexError, match="no level 5"):
            ask(5)


def test_nan_points_of_a_scan_are_counted():
    points = scan_room(pose_at(0, 0, 0))
    points[:10] = numpy.nan
    report = hgmm.Map().insert(points)
    assert report.points_not_finite == 10 and report.points_used == len(points) - 10
