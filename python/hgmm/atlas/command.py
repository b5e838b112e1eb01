"""hgmm-atlas: the command line."""
import argparse
import os
import sys
import warnings

from hgmm.atlas import plan
from hgmm.atlas.files import Folder

DONE, BAD_INPUT, WRONG_USAGE, INTERRUPTED = 0, 1, 2, 130


def positive(kind):
    def parse(text):
        value = kind(text)
        if not value > 0:
            raise argparse.ArgumentTypeError(f"must be more than 0, but is {text}")
        return value
    return parse


def parser():
    defaults = plan.Settings()
    options = argparse.ArgumentParser(
        prog="hgmm-atlas", description="Makes one map of many recordings, as a folder of tiles, "
        "with many processes. The same recordings give the same bytes for any number of them.")
    options.add_argument("logs", nargs="+", metavar="LOG", help="recordings (.rawlog)")
    options.add_argument("--poses", nargs="+", required=True, metavar="FILE",
                         help="poses of the robot, TUM lines in one frame; one file a log")
    options.add_argument("-o", "--output", required=True, metavar="FOLDER",
                         help="the atlas; one that was not finished is gone on with")
    options.add_argument("--scheduler", metavar="ADDRESS",
                         help="of Dask; without it, workers are started here")
    options.add_argument("--workers", type=positive(int), default=os.cpu_count(), metavar="N",
                         help="processes to start here (%(default)s)")
    options.add_argument("--scans", type=positive(int), default=500, metavar="N",
                         help="scans of a segment, at most (%(default)s)")
    options.add_argument("--tile", type=positive(float), default=defaults.tile_m, metavar="M",
                         help="edge of a tile (%(default)s m)")
    options.add_argument("--config", metavar="FILE", help="options of the map: an MRPT .ini")
    options.add_argument("--split", type=positive(int), default=0, metavar="K",
                         help="keep scans out for tests, as hgmm-replay does")
    return options


def main(words=None):
    options = parser().parse_args(words)
    if len(options.poses) != len(options.logs):
        print(f"hgmm-atlas: {len(options.logs)} logs, but {len(options.poses)} files of --poses",
              file=sys.stderr)
        return WRONG_USAGE
    try:
        # Everything else of the package works without it.
        from distributed.scheduler import KilledWorker
    except ImportError:
        print("hgmm-atlas: needs Dask distributed (Debian: python3-distributed)", file=sys.stderr)
        return BAD_INPUT
    try:
        return make(options)
    except KeyboardInterrupt:
        print("hgmm-atlas: interrupted; the same command goes on", file=sys.stderr)
        return INTERRUPTED
    except (OSError, ValueError, RuntimeError, KilledWorker) as error:
        print(f"hgmm-atlas: {error}", file=sys.stderr)
        return BAD_INPUT


def make(options):
    from distributed import Client

    from hgmm.atlas import run, tasks
    files = [*options.logs, *options.poses, *([options.config] if options.config else [])]
    for file in files:
        plan.state_of(file)  # what is missing is said before any work
    folder = Folder(options.output)
    folder.prepare()
    settings = plan.Settings(tile_m=options.tile, split=options.split,
                             config=os.path.abspath(options.config) if options.config else None)
    logs = [os.path.abspath(log) for log in options.logs]
    poses = [os.path.abspath(file) for file in options.poses]
    with cluster_of(options) as cluster, Client(cluster, set_as_default=False) as client:
        tell(f"progress at {client.dashboard_link}")
        scans = client.gather(client.map(tasks.count_scans, logs, pure=False))
        segments = plan.segments_of(logs, poses, scans, options.scans)
        tell(f"{sum(scans)} scans of {len(logs)} logs in {len(segments)} segments")
        index = run.make_atlas(client, segments, settings, folder, tell)
    size = sum(tile["bytes"] for tile in index["tiles"])
    tell(f"{folder.path}: {len(index['tiles'])} tiles, {size} bytes")
    return DONE


class Address:
    """A cluster that runs elsewhere, and goes on when this program ends."""

    def __init__(self, address):
        self.address = address

    def __enter__(self):
        return self.address

    def __exit__(self, *_):
        pass


def cluster_of(options):
    if options.scheduler:
        return Address(options.scheduler)
    from distributed import LocalCluster
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")  # of a dashboard whose port is taken
        return LocalCluster(n_workers=options.workers, threads_per_worker=1)


def tell(text):
    print(text, flush=True)
