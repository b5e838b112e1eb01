"""What is in the page of a map: places, shapes and answers are those of the map."""
import base64
import json
import re
import subprocess
import sys
import zlib

import numpy
import pytest

import hgmm
from hgmm.view import scene_of
from hgmm.view.inputs import read_points, read_poses
from hgmm.view.page import THREE_FOLDER, make_page
from hgmm.view.scene import quaternions_of
from hgmm.view.slices import STEPS

from conftest import HALF_SIZES


@pytest.fixture(scope="module")
def scene(room):
    return scene_of(room)


def rotations_of(turn):
    """Matrices of quaternions x y z w, by their definition."""
    x, y, z, w = turn.T
    return numpy.stack([1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w),
                        2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w),
                        2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)],
                       axis=1).reshape(-1, 3, 3)


def test_quaternions_turn_as_their_matrices_do():
    turn = numpy.random.default_rng(3).standard_normal((200, 4))
    turn /= numpy.linalg.norm(turn, axis=1, keepdims=True)
    half_turns = numpy.array([[1, 0, 0, 0], [0, 1, 0, 0], [0, 0, 1, 0], [0, 0, 0, 1.0]])
    rotations = rotations_of(numpy.concatenate([turn, half_turns]))
    numpy.testing.assert_allclose(rotations_of(quaternions_of(rotations)), rotations, atol=1e-12)


@pytest.mark.parametrize("kind", ["surfaces", "free"])
def test_ellipsoids_have_the_covariances_of_all_levels(room, scene, kind):
    ellipsoids = getattr(scene, kind)
    of_level = room.mixture if kind == "surfaces" else room.free_mixture
    axes = rotations_of(ellipsoids.turn / 32767)
    spread = axes * ellipsoids.deviation[:, None, :]
    covariance = spread @ spread.transpose(0, 2, 1)
    levels = len(room.info()["levels"])
    assert len(ellipsoids.first) == levels + 1 and ellipsoids.first[-1] == len(axes)
    for level in range(levels):
        ours = slice(*ellipsoids.first[level:level + 2])
        mixture = of_level(level)
        numpy.testing.assert_allclose(ellipsoids.mean[ours] + scene.centre, mixture.mean[:, :3],
                                      atol=1e-5)
        largest = ellipsoids.deviation[ours][:, :1, None] ** 2
        error = numpy.abs(covariance[ours] - mixture.covariance[:, :3, :3]) / largest
        assert error.max(initial=0) < 1e-3
    assert (numpy.diff(ellipsoids.deviation, axis=1) <= 0).all()


def test_answers_at_means_are_those_of_the_level(room, scene):
    ours = slice(*scene.surfaces.first[1:3])
    found = room.occupancy(room.mixture(1).mean, 1)
    numpy.testing.assert_array_equal(scene.occupied[ours], found.occupied)
    warm = room.modality("warm", room.mixture(1).mean)
    numpy.testing.assert_allclose(scene.modalities["warm"][ours, 0],
                                  numpy.where(warm.known, warm.mean, numpy.nan), rtol=1e-6)


def test_the_lattice_tells_the_room_from_what_is_beyond(room, scene):
    lattice = scene.lattice
    z, y, x = (axis.ravel() for axis in numpy.indices(lattice.answers.shape[:3]))
    centres = scene.centre + lattice.low + lattice.cell * (numpy.stack([x, y, z], axis=1) + 0.5)
    occupied, free = lattice.answers.reshape(-1, 2).T / STEPS
    depth = (HALF_SIZES - numpy.abs(centres)).min(axis=1)
    assert (depth < -0.1).any() and free[depth > 0.3].mean() > 0.9
    assert free[depth < -0.1].max() < 0.5 and (occupied + free <= 1).all()
    # A cell that no surface passes has the answer at its centre.
    picked = numpy.flatnonzero(occupied < 0.5)[::997]
    found = room.occupancy(centres[picked])
    assert numpy.abs(found.free - free[picked]).max() <= 0.5 / STEPS + 1e-6


def test_a_wall_between_centres_of_cells_is_occupied(room, scene):
    """A slice shows walls without holes, however thin they are."""
    lattice = scene.lattice
    # Cells of the wall at x = 4, where rays of the first scan met it.
    rays = numpy.linspace(-0.8, 0.8, 200)
    on_wall = numpy.stack([numpy.full(200, HALF_SIZES[0]), rays, numpy.zeros(200)], axis=1)
    index = numpy.floor((on_wall - scene.centre - lattice.low) / lattice.cell).astype(int)
    near = numpy.max([lattice.answers[index[:, 2], index[:, 1], index[:, 0] + step, 0]
                      for step in (-1, 0, 1)], axis=0)
    assert (near > STEPS / 2).mean() > 0.97


def unpacked(page):
    """The facts and arrays of a page, as its program reads them."""
    def script(name):
        return re.search(f'<script [^>]*id="{name}">(.*?)</script>', page, re.DOTALL).group(1)
    facts = json.loads(script("facts"))
    content = zlib.decompress(base64.b64decode(script("arrays")))
    return facts, {name: numpy.frombuffer(content, entry["type"], entry["count"], entry["at"])
                   for name, entry in facts["arrays"].items()}


@pytest.fixture(scope="module")
def inputs(tmp_path_factory):
    """A trajectory and points, as files."""
    folder = tmp_path_factory.mktemp("inputs")
    (folder / "path.tum").write_text("# t x y z qx qy qz qw\n"
                                     "2.5 1 0.5 0.2 0 0 0.34289781 0.93937271\n"
                                     "1.0 0 0 0 0 0 0 1\n4 -1.5 -1 0 0 0 0.84147098 0.54030231\n")
    (folder / "points.txt").write_text("x,y,z\n1,2,1\n-4.0,0,0.5\n")
    return folder


def test_the_page_holds_the_scene_and_nothing_from_elsewhere(room, inputs):
    scene = scene_of(room, read_poses(inputs / "path.tum"), read_points(inputs / "points.txt"))
    page = make_page(scene, "A <room> & {{STYLE}}")
    facts, arrays = unpacked(page)
    assert "<title>A &lt;room&gt; &amp; {{STYLE}}</title>" in page
    assert re.findall(r'(?:src|href)="(?!data:)', page) == [] and "@import" not in page
    numpy.testing.assert_array_equal(arrays["surfaces.mean"], scene.surfaces.mean.ravel())
    numpy.testing.assert_array_equal(arrays["lattice"], scene.lattice.answers.ravel())
    assert facts["surfaces"] == scene.surfaces.first
    assert sorted(facts["modalities"]) == ["cold", "warm"]
    # In the order of time, relative to the first and to the scene's centre.
    numpy.testing.assert_allclose(arrays["poses.time"], [0, 1.5, 3])
    numpy.testing.assert_allclose(arrays["poses.position"][3:6] + scene.centre, [1, 0.5, 0.2],
                                  atol=1e-6)
    numpy.testing.assert_allclose(arrays["points"][3:] + scene.centre, [-4, 0, 0.5], atol=1e-6)


def test_ply_points_are_read_as_hgmm_map_writes_them(tmp_path, room, map_tool):
    room.save(tmp_path / "room.hgmm")
    map_tool("sample", tmp_path / "room.hgmm", "-n", 500, "-o", tmp_path / "points.ply")
    points = read_points(tmp_path / "points.ply")
    assert points.shape == (500, 3)
    assert (numpy.abs(HALF_SIZES - numpy.abs(points)).min(axis=1) < 0.05).mean() > 0.9


@pytest.mark.parametrize("text, reason", [
    ("1 2 3\n1 2\n", "line 2 is not 3 finite numbers"),
    ("1 2 3\n1 2 nan\n", "line 2 is not 3 finite numbers"),
    ("1 2 3\n1 b 3\n", "line 2 is not 3 numbers"),
    ("# nothing\n", "holds no lines of 3 numbers"),
    ("ply\nformat ascii 1.0\nend_header\n", "only binary little-endian PLY"),
    ("ply\nformat binary_little_endian 1.0\nelement vertex 2\nproperty float x\n"
     "property float y\nproperty float z\nend_header\n", "ends before its 2 vertices do"),
])
def test_points_that_cannot_be_read_are_refused(tmp_path, text, reason):
    file = tmp_path / "points"
    file.write_text(text)
    with pytest.raises(ValueError, match=reason):
        read_points(file)


def run_view(*words, python=sys.executable):
    return subprocess.run([python, "-m", "hgmm.view", *map(str, words)], stdout=subprocess.PIPE,
                          stderr=subprocess.PIPE, text=True)


def test_the_program_says_what_is_wrong_and_leaves_nothing(tmp_path, inputs):
    hgmm.Map().save(tmp_path / "empty.hgmm")
    (tmp_path / "bad.tum").write_text("0 1 2 3 0 0 0 0\n")
    hgmm.Map().save(tmp_path / "room.hgmm")
    for words, reason in (
            [("missing.hgmm",), "missing.hgmm: No such file"],
            [("empty.hgmm",), "the map has no surfaces to show"],
            [("room.hgmm", "--poses", tmp_path / "bad.tum"), "null quaternion"],
            [("room.hgmm", "--points", tmp_path / "none"), "No such file"]):
        done = run_view(tmp_path / words[0], *words[1:])
        assert done.returncode == 1 and reason in done.stderr and done.stderr.count("\n") == 1
    assert list(tmp_path.glob("*.html*")) == []


def test_without_three_js_the_reason_is_said(room, scene, monkeypatch, tmp_path):
    assert (THREE_FOLDER / "three.min.js").exists()
    monkeypatch.setattr("hgmm.view.page.THREE_FOLDER", tmp_path)
    with pytest.raises(ImportError, match="install libjs-three"):
        make_page(scene, "room")
