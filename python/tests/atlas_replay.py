"""Stands for hgmm-replay in tests of the atlas: a log is a JSON file that says where the simulated
room is scanned from."""
import argparse
import json
import pathlib
import sys

import hgmm
from conftest import pose_at, scan_room

OPTIONS = {"cellAtOneMetre_m": 0.1, "similarityMax": 1.0}
"""of the maps: components that are small beside tiles and their margins"""


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("log")
    parser.add_argument("--count", action="store_true")
    parser.add_argument("--from", type=int, dest="first")
    parser.add_argument("--to", type=int, dest="last")
    parser.add_argument("--save-map")
    for ignored in ("--poses", "--threads"):
        parser.add_argument(ignored)
    parser.add_argument("--quiet", action="store_true")
    options = parser.parse_args()

    places = json.loads(pathlib.Path(options.log).read_text())
    if options.count:
        print(len(places))
        return
    room = hgmm.Map(**OPTIONS)
    for number in range(options.first, options.last + 1):
        if places[number] is None:
            sys.exit(f"{options.log}: scan {number} has no pose")
        pose = pose_at(*places[number])
        room.insert(scan_room(pose, seed=number), pose)
    room.save(options.save_map)


if __name__ == "__main__":
    main()
