"""Round trips through bytes, pickles and files, and files that are refused."""
import copy
import gzip
import pickle
import re
import struct

import numpy
import pytest

import hgmm
from conftest import map_of_room, pose_at, scan_room

GOLDEN = ["map_v0", "map_v1", "map_v2", "map_model_v4"]


def test_exact_bytes_and_copies_are_the_same_map(room):
    for other in (hgmm.Map.from_bytes(room.to_bytes(exact=True)), room.copy(), copy.copy(room),
                  copy.deepcopy(room), pickle.loads(pickle.dumps(room))):
        assert other == room and other.options == room.options
    changed = room.copy()
    changed.clear()
    assert changed != room and changed.empty


def test_a_pickled_map_goes_on_as_the_original_would():
    one = map_of_room()
    other = pickle.loads(pickle.dumps(one))
    for it in (one, other):
        it.insert(scan_room(pose_at(2, 1, 0)), pose_at(2, 1, 0))
    assert one == other


def test_compact_bytes(room, places):
    compact = hgmm.Map.from_bytes(room.to_bytes())
    assert len(room.to_bytes()) < len(room.to_bytes(exact=True)) / 2
    close = numpy.abs(compact.occupancy(places).free - room.occupancy(places).free)
    assert numpy.median(close) < 0.01


@pytest.mark.parametrize("exact", [False, True])
def test_file(tmp_path, room, exact):
    file = tmp_path / "room.hgmm"
    file.write_text("what was there before")
    room.save(file, exact=exact)
    read = hgmm.Map.load(str(file))
    assert read.to_bytes(exact=True) == hgmm.Map.from_bytes(
        room.to_bytes(exact)).to_bytes(exact=True)
    assert [f.name for f in tmp_path.iterdir()] == ["room.hgmm"]
    assert hgmm.Map.from_bytes(file.read_bytes()) == read
    (tmp_path / "bare").write_bytes(room.to_bytes(exact))
    assert hgmm.Map.load(tmp_path / "bare") == read


def test_the_tools_read_what_is_written_here(tmp_path, map_tool, room):
    file = tmp_path / "room.hgmm"
    room.save(file, exact=True)
    told = map_tool("info", file)
    assert f"{room.info()['saved_bytes']} bytes" in told
    points = numpy.array([[0.5, 0.2, 0.1], [4, 0.3, 0.1]])
    numpy.savetxt(tmp_path / "points", points)
    told = map_tool("query", file, "--modality", "warm", "--points", tmp_path / "points")
    numbers = [line.split() for line in told.splitlines() if not line.startswith("#")]
    occupancy, warm = room.occupancy(points), room.modality("warm", points)
    for i, line in enumerate(numbers):
        assert line[4:7] == [f"{a[i]:.4f}" for a in occupancy[:3]]
        assert line[9] == (f"{warm.mean[i]:.6g}" if warm.known[i] else "-")


def test_files_have_the_default_of_the_option_whose_absence_means_another(tmp_path, room, golden):
    page = (golden.parents[2] / "docs/options.md").read_text()
    default = float(re.search(r"^\| `independentPoints` \| ([0-9.]+) \|", page, re.M).group(1))
    room.save(tmp_path / "room.hgmm")
    content = gzip.decompress((tmp_path / "room.hgmm").read_bytes())
    name = b"\x11independentPoints"
    begin = content.index(name) + len(name)
    assert struct.unpack("<d", content[begin:begin + 8]) == (default,)


def test_what_the_tools_write_is_read_here(tmp_path, map_tool, golden):
    file = tmp_path / "sum.hgmm"
    map_tool("merge", golden / "map_model_v4.hgmm", golden / "map_v2.hgmm", "-o", file)
    expected = hgmm.Map.load(golden / "map_model_v4.hgmm")
    expected.merge(hgmm.Map.load(golden / "map_v2.hgmm"))
    assert hgmm.Map.load(file).to_bytes() == expected.to_bytes()


@pytest.mark.parametrize("name", GOLDEN)
def test_files_of_all_versions_give_the_answers_noted_beside_them(golden, name):
    saved = hgmm.Map.load(golden / f"{name}.hgmm")
    lines = (golden / f"{name}.txt").read_text().splitlines()
    assert len(saved.mixture().mean) == int(lines[0])
    noted = numpy.array([[float(x) for x in line.split()] for line in lines[1:]])
    answers = saved.occupancy(noted[:, :3])
    if name == "map_model_v4":  # those of older versions are older than coverage
        assert answers.occupied == pytest.approx(noted[:, 4], abs=1e-6)
        assert answers.free == pytest.approx(noted[:, 5], abs=1e-6)
    if noted.shape[1] > 6:
        means = [saved.modality(name, noted[:, :3]).mean for name in "rgb"]
        assert numpy.stack(means, axis=1) == pytest.approx(noted[:, 6:], abs=1e-6)


def test_a_file_that_lost_a_byte_anywhere_is_refused(tmp_path, golden):
    whole = (golden / "map_model_v4.hgmm").read_bytes()
    content = gzip.decompress(whole)
    file = tmp_path / "damaged.hgmm"
    cut = [whole[:n] for n in range(0, len(whole), 97)] + [whole + b"x"]
    packed = [gzip.compress(c) for c in (
        *(content[:n] for n in range(0, len(content), 211)), content + b"x",
        content.replace(b"CHGMM", b"CHGMN", 1),
        content[:30] + b"\x03" + content[31:],  # version
        content[:31] + b"\x08" + content[32:],  # flags
        content.replace(b"minLeaf_m", b"minLeaf_n", 1),
        content[:-1] + b"\x89")]
    for bytes_ in cut + packed:
        file.write_bytes(bytes_)
        with pytest.raises(hgmm.FormatError, match="damaged.hgmm"):
            hgmm.Map.load(file)
    assert issubclass(hgmm.FormatError, ValueError)


def test_files_that_cannot_be_opened(tmp_path, room):
    with pytest.raises(FileNotFoundError):
        hgmm.Map.load(tmp_path / "nothing.hgmm")
    with pytest.raises(IsADirectoryError):
        hgmm.Map.load(tmp_path)
    with pytest.raises(FileNotFoundError):
        room.save(tmp_path / "nowhere" / "room.hgmm")
    (tmp_path / "taken").mkdir()
    with pytest.raises(OSError):
        room.save(tmp_path / "taken")
    assert [f.name for f in tmp_path.iterdir()] == ["taken"]


@pytest.mark.parametrize("data", [b"", b"HGMM", b"x" * 1000, gzip.compress(b""),
                                  gzip.compress(b"x" * 99)])
def test_foreign_bytes(data):
    with pytest.raises(hgmm.FormatError):
        hgmm.Map.from_bytes(data)
