"""python3 -m hgmm.view MAP [-o PAGE.html] [--poses FILE] [--points FILE] [--up AXIS]"""
import argparse
import pathlib
import sys

from hgmm import Map
from hgmm.output import run_program, write_whole
from hgmm.view.inputs import read_points, read_poses
from hgmm.view.page import make_page
from hgmm.view.scene import scene_of


def arguments():
    parser = argparse.ArgumentParser(
        prog="python3 -m hgmm.view", description="Makes a page that shows a saved map in 3D.")
    parser.add_argument("map", metavar="MAP", help="saved map (.hgmm)")
    parser.add_argument("-o", "--output", metavar="PAGE.html",
                        help="the page; - for the terminal; default: MAP with .html")
    parser.add_argument("--poses", metavar="FILE.tum",
                        help="trajectory, TUM lines: t x y z qx qy qz qw")
    parser.add_argument("--points", metavar="FILE",
                        help="input points [m]: a PLY file, or lines x y z")
    parser.add_argument("--up", default="z", choices=["x", "-x", "y", "-y", "z", "-z"],
                        help="axis of the map that points up; write --up=-y; default: z")
    parser.add_argument("--title", help="default: the name of the map's file")
    return parser.parse_args()


def main():
    asked = arguments()
    poses = read_poses(asked.poses) if asked.poses else None
    points = read_points(asked.points) if asked.points else None
    map_ = Map.load(asked.map)
    if map_.empty:
        raise ValueError(f"{asked.map}: the map has no surfaces to show")
    scene = scene_of(map_, poses, points,
                     say=lambda text: print(f"{asked.map}: {text}", file=sys.stderr))
    page = make_page(scene, asked.title or pathlib.Path(asked.map).stem, asked.up)
    read = [file for file in (asked.map, asked.poses, asked.points) if file]
    write_whole(asked.output or pathlib.Path(asked.map).with_suffix(".html"), page, read)


if __name__ == "__main__":
    sys.exit(run_program("hgmm.view", main))
