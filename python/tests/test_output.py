"""Files of the programs: whole, never an input, and links stay."""
import os

import numpy
import pytest

from hgmm.output import write_whole
from hgmm.view.inputs import read_ply, read_poses


def test_inputs_are_not_replaced(tmp_path):
    map_ = tmp_path / "a.hgmm"
    map_.write_text("map")
    (tmp_path / "link").symlink_to(map_)
    for name in (map_, tmp_path / "link"):
        with pytest.raises(ValueError, match="is an input, too"):
            write_whole(name, "page", [str(map_)])
    assert map_.read_text() == "map"


def test_links_stay_and_devices_are_written_to(tmp_path):
    target = tmp_path / "page.html"
    target.write_text("old")
    (tmp_path / "link.html").symlink_to(target)
    write_whole(tmp_path / "link.html", "new")
    assert (tmp_path / "link.html").is_symlink() and target.read_text() == "new"
    write_whole("/dev/null", "nothing")
    assert not os.path.isfile("/dev/null")
    assert sorted(os.listdir(tmp_path)) == ["link.html", "page.html"]


def test_poses_are_read_as_the_programs_read_them(tmp_path):
    file = tmp_path / "poses.tum"
    file.write_text("1 0 0 0 0 0 0 2\n")
    assert numpy.allclose(read_poses(file).turn, [[0, 0, 0, 1]])
    for text in ("1 0 0 0 0 0 0 0\n", "1 0 0 0 0 1 0 0 0 0 1 0\n", "1 2 3\n"):
        file.write_text(text)
        with pytest.raises(ValueError, match="poses.tum"):
            read_poses(file)


@pytest.mark.parametrize("element", ["vertex", "vertex -1", "vertex 1 2"])
def test_damaged_ply_headers_are_named(element):
    head = f"ply\nformat binary_little_endian 1.0\nelement {element}\nend_header\n"
    with pytest.raises(ValueError, match="a.ply: its header is damaged"):
        read_ply("a.ply", head.encode())


def test_ply_headers_may_end_lines_as_windows_does():
    head = "ply\r\nformat binary_little_endian 1.0\r\nelement vertex 1\r\n" + "".join(
        f"property float {axis}\r\n" for axis in "xyz") + "end_header\r\n"
    vertices = read_ply("a.ply", head.encode() + numpy.array([1, 2, 3], "<f4").tobytes())
    assert vertices.tolist() == [(1, 2, 3)]
