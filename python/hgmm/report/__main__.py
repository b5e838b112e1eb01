"""python3 -m hgmm.report FOLDER [-o REPORT.html] [--poses FILE]"""
import argparse
import pathlib
import sys

from hgmm.output import run_program, write_whole
from hgmm.report.page import make_report


def arguments():
    parser = argparse.ArgumentParser(
        prog="python3 -m hgmm.report",
        description="Makes report.html of the metrics.json in a folder, with the map and the "
                    "points beside it.")
    parser.add_argument("folder", metavar="FOLDER", type=pathlib.Path)
    parser.add_argument("-o", "--output", metavar="REPORT.html",
                        help="the page; - for the terminal; default: report.html in the folder")
    parser.add_argument("--poses", metavar="FILE.tum",
                        help="trajectory that the view of the map shows")
    return parser.parse_args()


def main():
    asked = arguments()
    page = make_report(asked.folder, asked.poses,
                       say=lambda text: print(f"hgmm.report: {text}", file=sys.stderr))
    read = [*asked.folder.glob("*.json"), *asked.folder.glob("*.hgmm"), *asked.folder.glob("*.ply"),
            *([asked.poses] if asked.poses else [])]
    write_whole(asked.output or asked.folder / "report.html", page, read)


if __name__ == "__main__":
    sys.exit(run_program("hgmm.report", main))
