"""A picture of a map: python3 -m hgmm.picture MAP [-o PICTURE.png]"""
import argparse
import pathlib
import sys

import numpy

from hgmm import Map
from hgmm.output import run_program, write_whole
from hgmm.report.drawing import picture_figure, png_of, view_axes

SIGMAS = 2
LIGHT = numpy.array([-0.4, -0.6, -0.8]) / numpy.linalg.norm([0.4, 0.6, 0.8])
"""where it comes from (right, down, away)"""


def shades_of(covariance_view):
    """Brightness of each ellipsoid: of its flat side, turned to the viewer."""
    normal = numpy.linalg.eigh(covariance_view)[1][:, :, 0]
    normal *= -numpy.sign(normal[:, 2:])
    return 0.45 + 0.55 * numpy.maximum(0, normal @ LIGHT)


def picture_of(mixture, yaw_deg=30, pitch_deg=30, cut=0):
    """A PNG of a mixture's ellipsoids, seen from outside and coloured by height: dark at the
    lowest, yellow at the highest. Those farther away are drawn first.

    yaw_deg, pitch_deg: viewing direction about z, and how far it points down [deg].
    cut: share of the depth, from the viewer on, that is left out, in [0, 1).

    Raises ValueError for a mixture without components.
    """
    from matplotlib import colormaps
    from matplotlib.collections import EllipseCollection
    if len(mixture.support) == 0:
        raise ValueError("an empty map has no picture")
    axes_of_view = view_axes(yaw_deg, pitch_deg)
    seen = mixture.mean @ axes_of_view.T
    covariance = axes_of_view @ mixture.covariance @ axes_of_view.T
    reach = SIGMAS * numpy.sqrt(numpy.diagonal(covariance, axis1=1, axis2=2))
    low, high = (seen - reach).min(axis=0), (seen + reach).max(axis=0)
    heights = mixture.mean[:, 2]
    colours = colormaps["viridis"]((heights - heights.min()) / max(numpy.ptp(heights), 1e-9))
    colours[:, :3] *= shades_of(covariance)[:, None]
    order = numpy.argsort(-seen[:, 2], kind="stable")
    order = order[seen[order, 2] >= low[2] + cut * (high[2] - low[2])]
    squares, axes_2d = numpy.linalg.eigh(covariance[order, :2, :2])
    widths = 2 * SIGMAS * numpy.sqrt(numpy.maximum(squares, 0))
    angles = numpy.degrees(numpy.arctan2(axes_2d[:, 1, 1], axes_2d[:, 0, 1]))
    margin = 0.02 * (high - low)[:2].max()
    figure, axes = picture_figure(low[:2] - margin, high[:2] + margin)
    axes.add_collection(EllipseCollection(
        widths[:, 1], widths[:, 0], angles, units="xy", offsets=seen[order, :2],
        offset_transform=axes.transData, facecolors=colours[order], edgecolors="#0003",
        linewidths=0.4))
    return png_of(figure, dpi=180)


def arguments():
    parser = argparse.ArgumentParser(prog="python3 -m hgmm.picture",
                                     description="Draws the ellipsoids of a saved map.")
    parser.add_argument("map", metavar="MAP", help="saved map (.hgmm)")
    parser.add_argument("-o", "--output", metavar="PICTURE.png",
                        help="- for the terminal; default: MAP with .png")
    parser.add_argument("--level", type=int, default=0, help="of the hierarchy, 0 = finest")
    parser.add_argument("--yaw", type=float, default=30, help="viewing direction about z [deg]")
    parser.add_argument("--pitch", type=float, default=30, help="how far it points down [deg]")
    parser.add_argument("--cut", type=float, default=0,
                        help="share of the depth, from the viewer on, left out, in [0, 1)")
    return parser.parse_args()


def main():
    asked = arguments()
    if not 0 <= asked.cut < 1:
        raise ValueError("--cut must be in [0, 1)")
    if not numpy.isfinite([asked.yaw, asked.pitch]).all():
        raise ValueError("--yaw and --pitch must be finite")
    picture = picture_of(Map.load(asked.map).mixture(asked.level), asked.yaw, asked.pitch,
                         asked.cut)
    write_whole(asked.output or pathlib.Path(asked.map).with_suffix(".png"), picture, [asked.map])


if __name__ == "__main__":
    sys.exit(run_program("hgmm.picture", main))
