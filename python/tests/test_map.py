"""What a map does, from Python."""
import threading
import time

import numpy
import pytest

import hgmm
from conftest import HALF_SIZES, map_of_room, pose_at, scan_room


def test_room_is_free_and_its_walls_are_occupied(room):
    x = HALF_SIZES[0]
    occupied, free, unknown, along_ray, variance = room.occupancy(
        [[0.5, 0.2, 0.1], [x, 0.3, 0.1], [x + 1, 0.3, 0.1]])
    assert free[0] > 0.9 and occupied[1] > 0.5 and unknown[2] > 0.9
    assert (occupied + free + unknown) == pytest.approx(1, abs=1e-6)
    assert abs(along_ray[1]) < 0.05 and (variance >= 0).all()


def test_ray_meets_the_wall(room):
    hit = room.cast_ray([0, 0, 0], [2, 0, 0])
    assert hit.range == pytest.approx(HALF_SIZES[0], abs=0.03)
    assert hit.point == pytest.approx([HALF_SIZES[0], 0, 0], abs=0.03)
    assert room.cast_ray([0, 0, 0], [1, 0, 0], max_range=2) is None


def test_modality_and_inference(room):
    walls = [[HALF_SIZES[0], 0.2, 0.1], [-HALF_SIZES[0], 0.2, 0.1]]
    warm = room.modality("warm", walls)
    assert warm.known.all() and warm.mean == pytest.approx([0.9, 0.1], abs=0.05)
    inferred = room.infer("cold", {"warm": 0.9})
    assert inferred.known and inferred.mean == pytest.approx(0.1, abs=0.05)
    assert inferred.place[0] > 3 and inferred.place.shape == (3,)


def test_channels_that_the_map_does_not_model_are_ignored():
    points = scan_room(pose_at(0, 0, 0))
    plain, other = hgmm.Map(), hgmm.Map()
    plain.insert(points)
    other.insert(points, channels={"r": numpy.zeros(len(points))})
    assert plain == other


def test_cleared_rays_clear_space():
    x, y = numpy.mgrid[-0.3:0.3:0.02, -0.3:0.3:0.02].reshape(2, -1)
    rays = numpy.stack([x, y, numpy.full(x.shape, 1.4)], axis=1)
    point = [[0, 0, 0.8]]  # above all rings
    without, with_rays = hgmm.Map(), hgmm.Map()
    points = scan_room(pose_at(0, 0, 0), rings=8)
    without.insert(points, cleared_rays_sensor=0 * rays)
    with_rays.insert(points, cleared_rays_sensor=rays)
    assert without.occupancy(point).unknown > 0.9 and with_rays.occupancy(point).free > 0.5
    beyond = [[0, 0, 2]]
    assert with_rays.occupancy(beyond).unknown > 0.9


def test_samples_lie_on_the_walls_and_follow_the_seed(room):
    points = room.sample(1000, seed=3)
    to_walls = numpy.abs(HALF_SIZES - numpy.abs(points)).min(axis=1)
    assert numpy.median(to_walls) < 0.02
    assert numpy.array_equal(points, room.sample(1000, seed=3))
    assert not numpy.array_equal(points, room.sample(1000, seed=4))


def test_merge_in_another_frame():
    frame = pose_at(20, -7, 1, 0.4)
    one, other = map_of_room(), map_of_room(frame, seed=9)
    one.merge(other, frame)
    mean = one.mixture().mean
    assert (numpy.abs(mean) < HALF_SIZES + 0.1).all()
    itself = map_of_room()
    support = itself.info()["points"]
    itself.merge(itself)
    assert itself.info()["points"] == pytest.approx(2 * support, rel=1e-5)


def test_register_finds_the_pose_between_map_frames():
    frame = pose_at(220, -70, 3, 0.4)
    one, other = map_of_room(), map_of_room(frame, seed=9)
    off = pose_at(0.15, -0.1, 0.05, 0.04)
    found = one.register(other, off @ frame)
    assert found.converged and found.overlap > 0.5 and found.pose.shape == (4, 4)
    error = numpy.linalg.inv(frame) @ found.pose
    assert numpy.abs(error[:3, :3] - numpy.eye(3)).max() < 2e-3
    # Where the frame is far off, its origin moves with the rotation; what both map does not.
    middle_frame = numpy.linalg.inv(frame)[:3, 3]
    middle = found.pose[:3, :3] @ middle_frame + found.pose[:3, 3]
    assert numpy.abs(middle).max() < 0.01


def test_covariance_of_a_registration_belongs_to_the_map_frames():
    """Seen from the room's middle it is as small as that of frames which are near it."""
    near, far = pose_at(0, 0, 0), pose_at(200, -70, 3)
    one = map_of_room()
    covariances = []
    for frame in (near, far):
        found = one.register(map_of_room(frame, seed=9), frame)
        x, y, z = found.pose[:3, :3] @ numpy.linalg.inv(frame)[:3, 3]
        to_middle = numpy.eye(6)  # the error at the middle is v + w x (R middle)
        to_middle[3:, :3] = [[0, z, -y], [-z, 0, x], [y, -x, 0]]
        covariances.append(to_middle @ found.covariance @ to_middle.T)
        assert (numpy.linalg.eigvalsh(found.covariance) > 0).all()
    deviations = numpy.sqrt([c.diagonal() for c in covariances])
    assert (deviations < 0.05).all()
    assert deviations[0] == pytest.approx(deviations[1], rel=0.2)


def test_forget():
    room = map_of_room()
    n = len(room.mixture().mean)
    low, high = HALF_SIZES - 1, HALF_SIZES + 1
    inside = ((room.mixture().mean >= low) & (room.mixture().mean <= high)).all(axis=1).sum()
    assert inside > 0
    assert room.forget(low, high) == inside
    assert len(room.mixture().mean) == n - inside


def test_options_by_keyword():
    coarse = hgmm.Map(resolution_m=0.08, minCell_m=0.05, modalities="rgb, heat", levels=3).options
    assert coarse["minLeaf_m"] == pytest.approx(0.02)  # follows the resolution
    assert coarse["minCell_m"] == 0.05 and coarse["levels"] == 3
    assert coarse["modalities"] == ["r", "g", "b", "heat"]
    assert hgmm.Map(modalities=["r"]).options["modalities"] == ["r"]
    assert hgmm.Map(**coarse).options == coarse


@pytest.mark.parametrize("options, error, words", [
    ({"resolution": 1}, TypeError, "'resolution'; did you mean 'resolution_m'"),
    ({"contradictedKeep": 1}, TypeError, "did you mean 'carvedSupport'"),
    ({"levels": 0}, ValueError, "levels = 0"),
    ({"levels": 2.5}, TypeError, "levels = 2.5: must be a whole number"),
    ({"resolution_m": "fine"}, TypeError, "resolution_m = 'fine': must be a number"),
    ({"resolution_m": numpy.nan}, ValueError, "resolution_m = nan"),
    ({"minRange_m": 400}, ValueError, "minRange_m = 400: .*maxRange_m is 300"),
    ({"modalities": 3}, TypeError, "modalities = 3"),
    ({"modalities": ["a", "a"]}, ValueError, "named twice"),
])
def test_bad_options(options, error, words):
    with pytest.raises(error, match=words):
        hgmm.Map(**options)


def test_info_and_repr(room):
    info = room.info()
    assert [level["surface"] for level in info["levels"]] == [
        len(room.mixture(i).support) for i in range(5)]
    assert info["saved_bytes"] == len(room.to_bytes()) and info["live_bytes"] > 0
    assert info["options"] == room.options and set(info["modalities"]) == {"warm", "cold"}
    assert str(info["levels"][0]["surface"]) in repr(room) and not room.empty
    assert hgmm.Map().empty


def test_docstrings_name_shapes():
    for name in ("insert", "occupancy", "along_ray", "modality", "infer", "cast_ray", "sample",
                 "merge", "register", "forget"):
        assert "shape (" in getattr(hgmm.Map, name).__doc__, name


def test_threads_run_while_a_query_does(room):
    """The GIL is released: Python counts on while C++ answers a single call."""
    many = numpy.random.default_rng(1).uniform(-1, 1, (400_000, 3)) * HALF_SIZES
    done, ticks = threading.Event(), []

    def query():
        room.occupancy(many)
        done.set()

    thread = threading.Thread(target=query)
    thread.start()
    while not done.is_set():
        ticks.append(time.perf_counter())
        time.sleep(0.001)
    thread.join()
    assert len(ticks) > 10


def test_threads_share_a_map(places):
    """Readers get answers of the map before or after an insertion, none of a map in between."""
    growing = map_of_room()
    grown = growing.copy()
    scan, pose = scan_room(pose_at(2, 1, 0), seed=50), pose_at(2, 1, 0)
    grown.insert(scan, pose)
    expected = {numpy.stack(m.occupancy(places)).tobytes() for m in (growing, grown)}
    answers = [[], []]
    stop = threading.Event()

    def read(mine):
        while not stop.is_set() or not mine:
            mine.append(numpy.stack(growing.occupancy(places)).tobytes())

    threads = [threading.Thread(target=read, args=(mine,)) for mine in answers]
    for thread in threads:
        thread.start()
    growing.insert(scan, pose)
    stop.set()
    for thread in threads:
        thread.join()
    assert set(answers[0]) | set(answers[1]) <= expected
    assert growing == grown


def test_maps_that_merge_each_other_do_not_wait_for_ever():
    a, b = map_of_room(), map_of_room(seed=9)
    threads = [threading.Thread(target=lambda x=x, y=y: [x.merge(y) for _ in range(5)], daemon=True)
               for x, y in ((a, b), (b, a))]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join(timeout=60)
        assert not thread.is_alive()
