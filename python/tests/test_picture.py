"""The picture of a map's ellipsoids."""
import subprocess
import sys

import numpy
import pytest

pytest.importorskip("matplotlib")

from matplotlib import image  # noqa: E402

import hgmm  # noqa: E402
from hgmm.picture import SIGMAS, picture_of  # noqa: E402


def mixture_of(*components):
    mean, deviation = (numpy.array(v, float) for v in zip(*components))
    covariance = numpy.stack([numpy.diag(d ** 2) for d in deviation])
    return hgmm.Mixture(mean, covariance, numpy.ones(len(mean)))


def pixels_of(mixture, tmp_path, **view):
    (tmp_path / "m.png").write_bytes(picture_of(mixture, **view))
    return image.imread(tmp_path / "m.png")[..., :3]


def test_an_ellipse_is_as_wide_and_high_as_its_gaussian(tmp_path):
    # Seen along x: y from right to left, z upwards.
    pixels = pixels_of(mixture_of(((0, 0, 0), (0.1, 0.4, 0.2))), tmp_path, yaw_deg=0, pitch_deg=0)
    drawn = (pixels < 0.97).any(axis=2)
    rows, columns = drawn.any(axis=1).sum(), drawn.any(axis=0).sum()
    assert columns / rows == pytest.approx(2, abs=0.02)
    metre = columns / (2 * SIGMAS * 0.4)
    assert drawn.sum() == pytest.approx(numpy.pi * SIGMAS ** 2 * 0.4 * 0.2 * metre ** 2, rel=0.01)


def test_what_is_nearer_is_drawn_last_unless_it_is_cut_away(tmp_path):
    far, near, high = ((5, 0, 0), (0.1, 1, 1)), ((1, 0, -0.1), (0.1, 1, 1)), ((5, 0, 9), (1, 1, 1))
    low_first = pixels_of(mixture_of(far, near, high), tmp_path, yaw_deg=0, pitch_deg=0)
    far_last = pixels_of(mixture_of(near, high, far), tmp_path, yaw_deg=0, pitch_deg=0)
    numpy.testing.assert_array_equal(low_first, far_last)
    alone = pixels_of(mixture_of(far, near, high), tmp_path, yaw_deg=0, pitch_deg=0, cut=0.4)
    middle = alone.shape[0] * 8 // 10, alone.shape[1] // 2
    assert (alone[middle] != low_first[middle]).any()
    # By height: the highest is yellow, the lowest dark violet.
    red, green, blue = low_first[low_first.shape[0] // 6, low_first.shape[1] // 2]
    assert min(red, green) > 3 * blue
    red, green, blue = low_first[middle]
    assert blue > green


def test_the_program_refuses_what_it_cannot_draw(tmp_path, room):
    room.save(tmp_path / "room.hgmm")
    for words, reason in ([["--cut=1"], "--cut must be in [0, 1)"],
                          [["--yaw=nan"], "--yaw and --pitch must be finite"],
                          [["--level=99"], "level"]):
        done = subprocess.run([sys.executable, "-m", "hgmm.picture", tmp_path / "room.hgmm", *words],
                              stderr=subprocess.PIPE, text=True)
        assert done.returncode == 1 and reason in done.stderr and done.stderr.count("\n") == 1
    with pytest.raises(ValueError, match="an empty map has no picture"):
        picture_of(hgmm.Map().mixture())
