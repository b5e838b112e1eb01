"""Atlases: same bytes whoever makes them, tiles that answer as one map, and runs that go on."""
import json
import os
import pathlib
import random
import signal
import sys
from dataclasses import replace

import numpy
import pytest

import hgmm
from atlas_replay import OPTIONS
from conftest import HALF_SIZES, pose_at, scan_room
from hgmm.atlas import Atlas, plan
from hgmm.atlas.files import Folder

distributed = pytest.importorskip("distributed")

from hgmm.atlas import run  # noqa: E402: needs distributed
from hgmm.atlas.command import main  # noqa: E402

SETTINGS = plan.Settings(tile_m=3.0, margin_m=1.5)
SCANS = 3
"""of a segment"""


def places_of(log):
    """Where a log's scans are: x, y, z [m], yaw [rad]."""
    return [[-2.5 + 0.9 * i, -1.5 + 0.4 * i + log, 0.1 * log, 0.5 * i] for i in range(6)]


@pytest.fixture(scope="module")
def logs(tmp_path_factory):
    """Two logs of six scans with their poses, and a stand-in for hgmm-replay in the PATH."""
    folder = tmp_path_factory.mktemp("logs")
    for log in (0, 1):
        (folder / f"{log}.rawlog").write_text(json.dumps(places_of(log)))
        (folder / f"{log}.tum").write_text("")
    program = folder / "hgmm-replay"
    tests = pathlib.Path(__file__).parent
    program.write_text(f'#!/bin/sh\nPYTHONPATH={tests}:$PYTHONPATH '
                       f'exec {sys.executable} -B {tests / "atlas_replay.py"} "$@"\n')
    program.chmod(0o755)
    before = os.environ["PATH"]
    os.environ["PATH"] = f"{folder}:{before}"
    yield [str(folder / f"{log}.rawlog") for log in (0, 1)]
    os.environ["PATH"] = before


def segments_of(logs):
    return plan.segments_of(logs, [log.replace("rawlog", "tum") for log in logs],
                            [6] * len(logs), SCANS)


def new_folder(path):
    folder = Folder(path)
    folder.prepare()
    return folder


def content_of(folder):
    """All bytes of the result."""
    files = [folder.index, *sorted((folder.path / "tiles").iterdir())]
    return {file.name: file.read_bytes() for file in files}


def one_thread():
    """A cluster within this process."""
    return distributed.Client(processes=False, n_workers=1, threads_per_worker=1,
                              dashboard_address=None, set_as_default=False)


@pytest.fixture(scope="module")
def cluster(logs):
    with distributed.LocalCluster(n_workers=2, threads_per_worker=1,
                                  dashboard_address=None) as cluster:
        yield cluster


@pytest.fixture(scope="module")
def atlas(logs, tmp_path_factory):
    """Made by one thread, in order."""
    folder = new_folder(tmp_path_factory.mktemp("atlas") / "of-one")
    with one_thread() as client:
        run.make_atlas(client, segments_of(logs), SETTINGS, folder)
    return folder


@pytest.fixture(scope="module")
def whole(logs):
    """One map, merged of the segments' maps as the tree has it."""
    maps = []
    for log in (0, 1):
        for first in (0, SCANS):
            made = hgmm.Map(**OPTIONS)
            for number in range(first, first + SCANS):
                pose = pose_at(*places_of(log)[number])
                made.insert(scan_room(pose, seed=number), pose)
            maps.append(hgmm.Map.from_bytes(made.to_bytes()))
    for pair in (0, 2):
        maps[pair].merge(maps[pair + 1])
    maps[0].merge(maps[2])
    return hgmm.Map.from_bytes(maps[0].to_bytes())  # tiles are compact, too


def test_same_bytes_for_two_workers_one_of_which_is_killed(logs, atlas, cluster, tmp_path):
    folder = new_folder(tmp_path / "atlas")
    with distributed.Client(cluster, set_as_default=False) as client:
        workers = sorted(client.run(os.getpid).values())
        killed = []

        def kill_one(text):
            if "segments" in text and not killed:
                killed.append(workers[0])
                os.kill(workers[0], signal.SIGKILL)

        shuffled = segments_of(logs[::-1])
        random.Random(7).shuffle(shuffled)
        run.map_segments(client, shuffled, SETTINGS, folder, kill_one)
        run.make_atlas(client, segments_of(logs[::-1]), SETTINGS, folder)
        client.wait_for_workers(2)
        assert killed and killed[0] not in client.run(os.getpid).values()
    assert content_of(folder) == content_of(atlas)


def test_tiles_answer_as_one_map(atlas, whole):
    """At 10 000 points within 20 cm of the borders between tiles."""
    rng = numpy.random.default_rng(1)
    points = rng.uniform(-1.1, 1.1, (10000, 3)) * HALF_SIZES
    axis = rng.integers(0, 2, len(points))
    rows = numpy.arange(len(points))
    border = rng.choice([-3.0, 0.0, 3.0], len(points))
    border[axis == 1] = rng.choice([-3.0, 0.0], (axis == 1).sum())
    points[rows, axis] = border + rng.uniform(-0.2, 0.2, len(points))
    here, there = Atlas(atlas.path).occupancy(points), whole.occupancy(points)
    assert 0.02 < (there.occupied > 0.5).mean() and 0.4 < (there.free > 0.5).mean()
    # Where a tile's frame is not that of the whole, the last bits of floats may differ.
    for mine, of_whole in zip(here, there):
        assert abs(mine - of_whole).max() < 1e-3
    tile = Atlas(atlas.path).map_of(plan.Tile(0, 0))
    inside = points[(points[:, :2] > 0).all(axis=1) & (points[:, :2] < 3).all(axis=1)]
    distances = whole.distance(inside, max_distance=SETTINGS.margin_m)
    assert 0.2 < distances.known.mean()
    found = tile.distance(inside, max_distance=SETTINGS.margin_m)
    assert abs(found.distance - distances.distance).max() < 1e-4


def test_index_says_what_is_there(atlas):
    index = json.loads(atlas.index.read_text())
    assert [(s["log"], s["first"], s["last"]) for s in index["segments"]] == [
        ("0.rawlog", 0, 2), ("0.rawlog", 3, 5), ("1.rawlog", 0, 2), ("1.rawlog", 3, 5)]
    files = {tile["file"]: tile["bytes"] for tile in index["tiles"]}
    assert files == {f"tiles/{f.name}": f.stat().st_size
                     for f in (atlas.path / "tiles").iterdir()}
    assert {(-1, -1), (-1, 0), (0, -1), (0, 0)} <= {(t["x"], t["y"]) for t in index["tiles"]}
    answers = Atlas(atlas.path, loaded_tiles=1).occupancy(
        [[1, 1, 0], [numpy.nan, 0, 0], [1e4, 0, 0], [-1, -1, 0]])
    assert answers.unknown.tolist()[1:3] == [1, 1] and (answers.free[[0, 3]] > 0.5).all()


def test_a_second_run_goes_on(logs, atlas):
    made = content_of(atlas)
    times = {file: file.stat().st_mtime_ns for file in atlas.work.iterdir()}
    segment = atlas.segment(plan.segment_name(segments_of(logs)[2], SETTINGS))
    lost = [segment, atlas.shard(plan.shard_name(segment.stem, plan.Tile(0, 0))), atlas.index,
            atlas.tile(plan.Tile(0, 0))]
    for file in lost:
        file.unlink()
    atlas.tile(plan.Tile(77, 0)).write_bytes(b"of an earlier atlas")
    with one_thread() as client:
        run.make_atlas(client, segments_of(logs), SETTINGS, atlas)
    assert content_of(atlas) == made
    remade = {file for file, time in times.items() if file.stat().st_mtime_ns != time}
    assert set(lost[:2]) <= remade
    assert all(segment.stem in file.stem or file in lost or
               file.stem in {plan.shard_name(segment.stem, tile)
                             for tile in Atlas(atlas.path).tiles} for file in remade)


def test_segments_cover_each_log_once_whatever_their_order():
    logs, poses, scans = ["b", "a", "c"], ["pb", "pa", "pc"], [1000, 7, 501]
    segments = plan.segments_of(logs, poses, scans, 500)
    assert segments == plan.segments_of(logs[::-1], poses[::-1], scans[::-1], 500)
    for log, pose, count in zip(logs, poses, scans):
        own = [s for s in segments if s.log == log]
        assert [n for s in own for n in range(s.first, s.last + 1)] == list(range(count))
        assert {s.poses for s in own} == {pose}
        assert max(s.last - s.first for s in own) < 500


def test_the_tree_depends_on_segments_alone():
    leaves = {0: "a", 2: "c", 3: "d", 6: "g"}
    root, nodes = plan.merges_of(leaves)
    parts = {node.name: (node.left, node.right) for node in nodes}

    def spelled(name):
        return f"({spelled(parts[name][0])}{spelled(parts[name][1])})" if name in parts else name

    assert spelled(root) == "((a(cd))g)"
    assert plan.merges_of(dict(reversed(leaves.items()))) == (root, nodes)
    more = plan.merges_of({**leaves, 9: "j"})[1]
    assert nodes == more[:-1]  # what was merged before stays
    assert plan.merges_of({5: "f"}) == ("f", [])


def test_segments_are_made_anew_when_an_input_changes(logs):
    segment = segments_of(logs)[0]
    names = {plan.segment_name(segment, SETTINGS),
             plan.segment_name(replace(segment, last=1), SETTINGS),
             plan.segment_name(segment, replace(SETTINGS, margin_m=2.0)),
             plan.segment_name(segment, replace(SETTINGS, config=logs[1]))}
    os.utime(segment.poses, ns=(0, 0))
    assert len(names | {plan.segment_name(segment, SETTINGS)}) == 5


def test_command(logs, cluster, tmp_path, capfd):
    poses = [log.replace("rawlog", "tum") for log in logs]
    made = main([*logs, "--poses", *poses, "-o", str(tmp_path / "atlas"), "--tile", "4",
                 "--scans", "6", "--scheduler", cluster.scheduler_address])
    out = capfd.readouterr().out
    assert made == 0 and "12 scans of 2 logs in 2 segments" in out and "2 of 2 segments" in out
    assert Atlas(tmp_path / "atlas").occupancy([[1, 1, 0]]).free[0] > 0.5


def test_a_foreign_folder_is_refused_and_left_alone(tmp_path):
    (tmp_path / "tiles").mkdir()
    (tmp_path / "tiles" / "mine.hgmm").write_text("mine")
    (tmp_path / "index.json").write_text('{"format": "of another program"}')
    with pytest.raises(ValueError, match="no index of an atlas"):
        new_folder(tmp_path)
    assert (tmp_path / "tiles" / "mine.hgmm").read_text() == "mine"
    assert json.loads((tmp_path / "index.json").read_text())["format"] == "of another program"


def test_rays_outside_a_box_do_not_count_however_far_the_origin_is():
    from hgmm.atlas.tasks import has_rays
    points_sensor = scan_room(pose_at(0, 0, 0))
    for origin in ([0, 0, 0], [480_000, 5_400_000, 0]):
        made = hgmm.Map()
        made.insert(points_sensor, pose_at(*origin))
        outside = numpy.add(origin, [HALF_SIZES[0] + 2.0, -1, -1])
        assert not has_rays(made, (outside, outside + 2.0))
        assert has_rays(made, (numpy.subtract(origin, 1.0), numpy.add(origin, 1.0)))


def test_bad_input_is_said_and_loses_nothing(logs, cluster, tmp_path, capfd):
    address = ["--scheduler", cluster.scheduler_address]
    poses = [log.replace("rawlog", "tum") for log in logs]
    assert main([*logs, "--poses", poses[0], "-o", str(tmp_path / "a"), *address]) == 2
    missing = str(tmp_path / "none.rawlog")
    assert main([missing, "--poses", poses[0], "-o", str(tmp_path / "a"), *address]) == 1
    assert missing in capfd.readouterr().err
    assert not (tmp_path / "a").exists()
    (tmp_path / "other").mkdir()
    (tmp_path / "other" / "mine.txt").write_text("mine")
    assert main([logs[0], "--poses", poses[0], "-o", str(tmp_path / "other"), *address]) == 1
    assert "other files" in capfd.readouterr().err
    assert os.listdir(tmp_path / "other") == ["mine.txt"]
    broken = tmp_path / "broken.rawlog"
    broken.write_text(json.dumps([places_of(0)[0], None]))
    assert main([str(broken), "--poses", poses[0], "--scans", "1", "-o", str(tmp_path / "b"),
                 *address]) == 1
    assert "scan 1 has no pose" in capfd.readouterr().err
    assert not Folder(tmp_path / "b").index.exists()
    with pytest.raises(OSError):
        Atlas(tmp_path / "b")
